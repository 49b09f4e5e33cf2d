// Work that goes on after it was stopped, and parts that are joined: never two states of the world.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/processes.h"
#include "tests/tools/sequences.h"
#include "tests/tools/temporary_folder.h"

namespace lcs {
namespace {

namespace fs = std::filesystem;
using test::bytes_in;
using test::CommandResult;
using test::entries;
using test::read;
using test::write;
using Words = std::vector<std::string>;

/// A detector that calls nothing a rebel.
constexpr const char* kDetector = R"(import json, sys
source = sys.stdin.buffer
size = json.loads(source.readline())["picture"]["bytes"]
print(json.dumps({"protocol": 1}), flush=True)
for line in iter(source.readline, b""):
    source.read(size)
    print(json.dumps({"index": json.loads(line)["index"], "rebel": []}), flush=True)
)";

class GoingOn : public testing::Test {
 protected:
  GoingOn() {
    write(home_ / "scenes" / "wall.xml", wall("0.5"));
    write(home_ / "scenes" / "own.xml",
          "<mujoco><worldbody><light pos='0 0 5'/><geom name='floor' type='plane' size='20 20 .1'/>"
          "<include file='wall.xml'/></worldbody></mujoco>");
    for (const char* name : {"a", "b"}) {
      write(
          home_ / "s" / fmt::format("{}.yaml", name),
          "purpose: a wall\nscene: ../scenes/own.xml\nframes: 3\nego: {start: [-4 m, 0 m], speed: "
          "0.5 m/s}\ncamera: {size: [160, 120]}\n");
    }
    write(home_ / "det.py", kDetector);
  }
  static std::string wall(const std::string& grey) {
    return fmt::format(
        "<mujocoinclude><geom type='box' pos='0 2 1' size='1 .1 1' rgba='{0} {0} {0} 1'/>"
        "<body name='box' pos='0 -1 .3'><geom type='box' size='.3 .3 .3' rgba='.9 .2 .2 1'/></body>"
        "</mujocoinclude>",
        grey);
  }
  void change_wall() { write(home_ / "scenes" / "wall.xml", wall("0.9")); }

  CommandResult lcs(const Words& words) { return test::run_lcs(words, {.folder = home_}); }
  static Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// Kills a command as soon as `is_time`, and waits until its children have tidied up.
  /// \return false if the command was done before.
  bool is_killed(const Words& words, const std::function<bool()>& is_time) {
    test::Command command(words, {.folder = home_});
    while (command.is_running() && !is_time()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::vector<pid_t> children = test::children_of(command.pid());
    command.send(SIGKILL);
    const bool is_done = command.wait().exit_code == 0;
    for (const pid_t child : children) {
      while (test::is_running(child)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return !is_done;
  }
  /// Likewise as soon as a file is there, and again if the command was too fast.
  void kill_at(const Words& words, const fs::path& file, const fs::path& result) {
    const auto is_there = [&] { return fs::exists(home_ / file); };
    for (int tries = 0; !is_killed(words, is_there); ++tries) {
      ASSERT_LT(tries, 20) << "it was always done before it could be killed";
      fs::remove_all(home_ / result);
    }
  }
  /// A suite of two runs, one after the other, that is killed after the first.
  void begin_suite(const Words& more, const std::string& first = "a") {
    kill_at(joined({"suite", "s", "--seeds", "1", "--jobs", "1", "--out", "o"}, more),
            fmt::format("o.unfinished/in/runs/{}/seed-1/metrics.json", first), "o");
  }
  CommandResult go_on(const Words& more) {
    return lcs(joined({"suite", "s", "--seeds", "1", "--jobs", "1", "--out", "o"}, more));
  }
  /// The command is refused in one line that names the difference, and nothing is changed.
  void expect_refused(const Words& words, const std::string& what) {
    const auto before = bytes_in(home_);
    const CommandResult result = lcs(words);
    EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << what << " is not in: " << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_EQ(bytes_in(home_), before);
  }
  void expect_refused_suite(const Words& more, const std::string& what) {
    expect_refused(joined({"suite", "s", "--seeds", "1", "--jobs", "1", "--out", "o"}, more), what);
  }
  /// A part of the suite, and its other part after a change.
  void make_parts(const Words& first, const Words& second, const std::function<void()>& change) {
    const Words suite{"suite", "s", "--seeds", "1", "--quiet"};
    ASSERT_EQ(lcs(joined(joined(suite, {"--shard", "1/2", "--out", "p1"}), first)).exit_code, 0);
    change();
    ASSERT_EQ(lcs(joined(joined(suite, {"--shard", "2/2", "--out", "p2"}), second)).exit_code, 0);
  }

  const test::TemporaryFolder folder_;
  const fs::path home_ = fs::canonical(folder_.path());
};

// ---- A suite that goes on

TEST_F(GoingOn, SuiteIsRefusedAfterAFileThatTheSceneIncludesWasChanged) {
  begin_suite({});
  change_wall();
  expect_refused_suite({}, "scenes/wall.xml was changed since");
  ASSERT_EQ(go_on({"--anew", "--quiet"}).exit_code, 0);
}

TEST_F(GoingOn, SuiteIsRefusedAfterTheScriptOfItsDetectorWasChanged) {
  const Words detector{"--detector-command", "python3 'det.py'"};
  begin_suite(detector);
  write(home_ / "det.py", std::string("# other\n") + kDetector);
  expect_refused_suite(detector, "det.py differs");
}

TEST_F(GoingOn, SuiteIsRefusedAfterItsDetectionsOrItsRecordingWereChanged) {
  ASSERT_EQ(lcs({"suite", "s", "--seeds", "1", "--out", "rec", "--quiet"}).exit_code, 0);
  for (const char* name : {"a", "b"}) write(home_ / "csv" / name / "seed-1.csv", "frame,type\n");
  const Words recorded{"--recorded", "rec", "--detections", "csv"};
  begin_suite(recorded);
  write(home_ / "csv" / "b" / "seed-1.csv", "frame,type\n\n");
  expect_refused_suite(recorded, "csv/b/seed-1.csv differs");
  write(home_ / "csv" / "b" / "seed-1.csv", "frame,type\n");
  ASSERT_EQ(lcs({"suite", "s", "--seeds", "1", "--out", "rec", "--quiet"}).exit_code, 0);
  expect_refused_suite(recorded, "rec/suite.json differs");
}

TEST_F(GoingOn, SuiteIsRefusedAfterAFinishedRunWasEdited) {
  begin_suite({});
  const fs::path metrics = home_ / "o.unfinished/in/runs/a/seed-1/metrics.json";
  write(metrics, read(metrics) + " ");
  expect_refused_suite({}, "metrics.json was changed since lcs wrote it");
  fs::remove_all(metrics.parent_path());
  EXPECT_EQ(go_on({"--quiet"}).exit_code, 0);
}

TEST_F(GoingOn, SuiteStopsIfAFileIsChangedBetweenTwoOfItsRuns) {
  // The detector of the first run changes the scene, which that run has read, before the second.
  write(home_ / "det.py",
        std::string(kDetector) + "open('scenes/wall.xml', 'a').write('<!-- later -->\\n')\n");
  const CommandResult result = go_on({"--detector-command", "python3 det.py"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("b seed 1 has read scenes/wall.xml in another state"),
            std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(home_ / "o"));
}

TEST_F(GoingOn, SuiteOfFiguresKeepsItsRunsUntilItIsCommitted) {
  const Words suite{"suite", "s", "--seeds", "1", "--jobs", "1", "--keep", "figures", "--out", "o"};
  kill_at(suite, "o.unfinished/in/suite.json", "o");
  const CommandResult result = lcs(suite);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("going on, with 2 of the runs there already"), std::string::npos)
      << result.err;
  EXPECT_EQ(entries(home_ / "o").count("runs"), 0u);
  EXPECT_FALSE(fs::exists(home_ / "o.unfinished"));
}

TEST_F(GoingOn, FolderOfOthersInPlaceOfTheUnfinishedOneIsRefused) {
  fs::create_directories(home_ / "else" / "out");
  fs::create_directory_symlink(home_ / "else", home_ / "o.unfinished");
  expect_refused_suite({}, "o.unfinished is in the way");
  EXPECT_TRUE(fs::exists(home_ / "else" / "out"));
  fs::remove(home_ / "o.unfinished");
  fs::create_directories(home_ / "o.unfinished" / "out" / "thesis");
  expect_refused_suite({}, "o.unfinished is in the way");
}

// ---- Parts

TEST_F(GoingOn, PartsOfDifferentScenesAreNotMerged) {
  make_parts({}, {}, [&] { change_wall(); });
  expect_refused({"merge", "p1", "p2", "--out", "m"},
                 "p1 and p2 are no parts of one suite: scenes/wall.xml differs");
}

TEST_F(GoingOn, PartsOfDifferentDetectorsAreNotMerged) {
  make_parts({"--detector-command", "python3 det.py"}, {"--detector-command", "python3  det.py"},
             [] {});
  expect_refused({"merge", "p1", "p2", "--out", "m"},
                 "detector_command differs ('python3 det.py' and 'python3  det.py')");
}

TEST_F(GoingOn, PartsOfOneDetectorInDifferentStatesAreNotMerged) {
  const Words detector{"--detector-command", "python3 det.py"};
  make_parts(detector, detector, [&] { write(home_ / "det.py", std::string("#\n") + kDetector); });
  expect_refused({"merge", "p1", "p2", "--out", "m"}, "det.py differs");
}

TEST_F(GoingOn, PartsThatKeepDifferentFilesAreNotMerged) {
  make_parts({"--keep", "figures"}, {}, [] {});
  expect_refused({"merge", "p1", "p2", "--out", "m"}, "keep differs ('figures' and 'all')");
}

TEST_F(GoingOn, PartsOfDifferentDetectionsAreNotMerged) {
  ASSERT_EQ(lcs({"suite", "s", "--seeds", "1", "--out", "rec", "--quiet"}).exit_code, 0);
  for (const char* name : {"a", "b"}) write(home_ / "csv" / name / "seed-1.csv", "frame,type\n");
  const Words recorded{"--recorded", "rec", "--detections", "csv"};
  make_parts(recorded, recorded,
             [&] { write(home_ / "csv" / "a" / "seed-1.csv", "frame,type\n\n"); });
  expect_refused({"merge", "p1", "p2", "--out", "m"}, "csv/a/seed-1.csv differs");
}

TEST_F(GoingOn, PartsOfTwoFoldersWithCopiesOfTheFilesAreMerged) {
  make_parts({}, {}, [] {});
  const test::TemporaryFolder other;
  fs::copy(home_, other.path() / "copy", fs::copy_options::recursive);
  const fs::path there = fs::canonical(other.path() / "copy");
  fs::remove_all(there / "p1");
  fs::remove_all(there / "p2");
  ASSERT_EQ(
      test::run_lcs({"suite", "s", "--seeds", "1", "--shard", "2/2", "--out", "p2", "--quiet"},
                    {.folder = there})
          .exit_code,
      0);
  const CommandResult result = lcs({"merge", "p1", there / "p2", "--out", "m", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(GoingOn, MergedProvenanceIsThatOfTheWhole) {
  make_parts({}, {}, [] {});
  ASSERT_EQ(lcs({"merge", "p1", "p2", "--out", "m", "--quiet"}).exit_code, 0);
  ASSERT_EQ(lcs({"suite", "s", "--seeds", "1", "--out", "whole", "--quiet"}).exit_code, 0);
  const auto facts = [&](const char* folder) {
    auto json = nlohmann::json::parse(read(home_ / folder / "run.json"));
    for (const char* name : {"command", "started", "wall_s", "cpu_s"}) json.erase(name);
    return json;
  };
  EXPECT_EQ(facts("m"), facts("whole"));
  EXPECT_TRUE(facts("m").at("read").contains("scenes/wall.xml"));
}

TEST_F(GoingOn, PartThatNamesAFolderOutsideIsRefused) {
  make_parts({}, {}, [] {});
  const fs::path suite = home_ / "p1" / "suite.json";
  const std::string before = read(suite);
  for (const std::string folder : {"a/../../../payload", "/tmp/payload", ".."}) {
    auto json = nlohmann::json::parse(before);
    json.at("scenarios").at(0).at("runs").at(0).at("folder") = folder;
    write(suite, json.dump());
    fs::remove(home_ / "p1" / ".lcs-written");  // as somebody else would do
    write(home_ / "payload" / "pre-commit", "evil");
    const CommandResult result = lcs({"merge", "p1", "p2", "--out", "jo/x/m"});
    EXPECT_EQ(result.exit_code, 2) << folder;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(home_ / "jo"));
    EXPECT_EQ(lcs({"compare", "p1", "p2"}).exit_code, 2) << "compare reads it, too";
  }
}

TEST_F(GoingOn, PartThatLacksFilesOrHasOthersIsRefused) {
  make_parts({}, {}, [] {});
  const fs::path truth = home_ / "p1" / "runs/a/seed-1/truth.jsonl.gz";
  const std::string before = read(truth);
  write(truth, before + "x");
  expect_refused({"merge", "p1", "p2", "--out", "m"}, "truth.jsonl.gz was changed since");
  fs::remove(truth);
  expect_refused({"merge", "p1", "p2", "--out", "m"}, "truth.jsonl.gz is missing");
}

// ---- A suite that ends when its verdict is certain

TEST_F(GoingOn, SuiteEndsWhenItsVerdictIsCertainAlsoAfterAKillAndMakesAllRunsIfAsked) {
  const Words suite{"suite", "s", "--seeds", "6", "--jobs", "1", "--set", "frames=8"};
  ASSERT_EQ(lcs(joined(suite, {"--out", "before", "--quiet"})).exit_code, 0);
  const auto runs_in = [&](const char* folder) {
    return nlohmann::json::parse(read(home_ / folder / "suite.json"))["scenarios"][0]["runs"]
        .size();
  };
  const Words again = joined(suite, {"--out", "after", "--baseline", "before"});
  const CommandResult stopped = lcs(again);
  ASSERT_EQ(stopped.exit_code, 0) << stopped.err;
  // Equal to the last bit: half of the 12 runs, three seeds of both scenarios, suffice.
  EXPECT_NE(stopped.out.find("2 as before, after 6 of 12 runs (--all makes them all)"),
            std::string::npos)
      << stopped.out;
  EXPECT_EQ(runs_in("after"), 3u);
  EXPECT_FALSE(fs::exists(home_ / "after.unfinished"));
  const CommandResult compared = lcs({"compare", "before", "after"});
  EXPECT_EQ(compared.exit_code, 0) << "runs that it did not make are not missing: " << compared.out;

  const Words killed = joined(suite, {"--out", "killed", "--baseline", "before"});
  kill_at(killed, "killed.unfinished/in/runs/a/seed-2/metrics.json", "killed");
  ASSERT_EQ(lcs(killed).exit_code, 0);
  EXPECT_EQ(runs_in("killed"), 3u);
  EXPECT_EQ(lcs({"compare", "after", "killed", "--frames"}).exit_code, 0);

  const CommandResult all = lcs(joined(again, {"--all", "--quiet"}));
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(runs_in("after"), 6u);
}

TEST_F(GoingOn, SuiteThatLacksRunsOfItsBaselineMakesAllOfItsOwn) {
  ASSERT_EQ(lcs({"suite", "s", "--seeds", "7", "--out", "before", "--quiet"}).exit_code, 0);
  const CommandResult fewer = lcs({"suite", "s", "--seeds", "6", "--out", "after", "--baseline",
                                   "before", "--fail-on-regression"});
  EXPECT_EQ(fewer.exit_code, 2);
  EXPECT_NE(fewer.out.find("not judged: missing or other frames than before"), std::string::npos)
      << fewer.out;
  EXPECT_EQ(fewer.out.find("--all makes them all"), std::string::npos) << fewer.out;
}

// ---- Recordings and baselines

TEST_F(GoingOn, RecordingOfAnotherSceneIsRefused) {
  ASSERT_EQ(lcs({"run", "s/a.yaml", "--out", "r", "--no-video", "--quiet"}).exit_code, 0);
  change_wall();
  expect_refused({"run", "s/a.yaml", "--recorded", "r", "--no-video", "--out", "again"},
                 "r is no recording of this run: scenes/wall.xml was changed since");
}

TEST_F(GoingOn, BaselineOfAnotherSceneIsTold) {
  const Words suite{"suite", "s", "--seeds", "1", "--quiet"};
  ASSERT_EQ(lcs(joined(suite, {"--out", "before"})).exit_code, 0);
  change_wall();
  const CommandResult result = lcs(joined(suite, {"--out", "after", "--baseline", "before"}));
  EXPECT_NE(result.err.find("were not made of the same files: scenes/wall.xml differs"),
            std::string::npos)
      << result.err;
}

// ---- Sequences

class GoingOnWithASequence : public GoingOn {
 protected:
  const Words euroc_{"generate", "s/a.yaml", "--set",     "frames=40",
                     "--out",    "q",        "--formats", "euroc"};
  const Words coco_ = joined(
      {"generate", "s/a.yaml", "--set", "frames=40", "--out", "q", "--formats"}, {"coco", "--add"});
  static std::map<std::string, std::string> sequence(const fs::path& folder) {
    auto files = bytes_in(folder);
    files.erase(".lcs-written");
    return files;
  }
  /// As soon as a frame is in the journal of the process.
  void kill_after_a_frame(const Words& words) {
    ASSERT_TRUE(is_killed(words, [&] { return test::has_frame(home_ / "q.unfinished"); }))
        << "it was done before it could be killed";
  }
};

TEST_F(GoingOnWithASequence, IsRefusedAfterAFileThatTheSceneIncludesWasChanged) {
  kill_after_a_frame(euroc_);
  change_wall();
  expect_refused(euroc_, "wall.xml was changed since");
}

TEST_F(GoingOnWithASequence, FinishedOneOfAnotherSceneIsNotCalledComplete) {
  ASSERT_EQ(lcs(euroc_).exit_code, 0);
  change_wall();
  expect_refused(euroc_, "wall.xml was changed since");
}

TEST_F(GoingOnWithASequence, KilledAddingLeavesTheSequenceAndTheSameCommandFinishes) {
  ASSERT_EQ(lcs(euroc_).exit_code, 0);
  const auto before = bytes_in(home_ / "q");
  kill_after_a_frame(coco_);
  EXPECT_EQ(bytes_in(home_ / "q"), before);
  const CommandResult first = lcs(euroc_);
  EXPECT_NE(first.out.find("is complete"), std::string::npos) << first.err;
  ASSERT_EQ(lcs(coco_).exit_code, 0);
  EXPECT_FALSE(fs::exists(home_ / "q.unfinished"));
  Words whole = euroc_;
  whole.back() = "euroc,coco";
  whole[5] = "w";
  ASSERT_EQ(lcs(whole).exit_code, 0);
  EXPECT_EQ(sequence(home_ / "q"), sequence(home_ / "w"));
}

TEST_F(GoingOnWithASequence, AddingThatFailsLeavesNothingBehind) {
  ASSERT_EQ(lcs(euroc_).exit_code, 0);
  change_wall();
  expect_refused(coco_, "wall.xml was changed since");
  write(home_ / "scenes" / "wall.xml", wall("0.5"));
  EXPECT_EQ(lcs(euroc_).exit_code, 0);
  EXPECT_EQ(lcs(coco_).exit_code, 0);
}

}  // namespace
}  // namespace lcs
