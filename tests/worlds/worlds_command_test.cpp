// `lcs world` and `lcs suite --worlds` from their command lines to their files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenarios/input/input_file.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/suite/suite_result.h"

namespace lcs::worlds {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;

class WorldCommand : public testing::Test {
 protected:
  CommandResult run(const std::vector<std::string>& arguments) {
    return test::run_lcs(arguments, {.folder = folder_.path()});
  }
  const test::TemporaryFolder folder_;
};

TEST_F(WorldCommand, WritesAScenarioThatRunsLikeAnyOther) {
  const CommandResult made = run({"world", "corridor", "--seed", "4", "--out", "mine"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(
      test::entries(folder_.path() / "mine"),
      (std::set<std::string>{"corridor_4.yaml", "scene.xml", "plan.png", "textures", "meshes"}));
  fs::rename(folder_.path() / "mine", folder_.path() / "moved");  // no file has the path
  const CommandResult ran =
      run({"run", "moved/corridor_4.yaml", "--no-video", "--set", "frames=4"});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "corridor_4" / "metrics.json"));
}

TEST_F(WorldCommand, ASheetShowsIt) {
  ASSERT_EQ(run({"world", "corridor", "--seed", "4", "--sheet", "--out", "mine"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_.path() / "mine" / "sheet.png"));
}

TEST_F(WorldCommand, ReplacesNoWorldThatWasEdited) {
  const std::vector<std::string> command{"world", "corridor", "--seed", "4", "--out", "mine"};
  ASSERT_EQ(run(command).exit_code, 0);
  ASSERT_EQ(run(command).exit_code, 0) << "its own";
  std::ofstream(folder_.path() / "mine" / "scene.xml") << "edited";
  const CommandResult again = run(command);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("scene.xml was changed since lcs wrote it"), std::string::npos)
      << again.err;
  EXPECT_EQ(test::read(folder_.path() / "mine" / "scene.xml"), "edited");
}

TEST_F(WorldCommand, MistakesAreToldInOneLineAndNothingIsWritten) {
  fs::create_directory(folder_.path() / "empty");
  fs::create_directory(folder_.path() / "broken");
  std::ofstream(folder_.path() / "broken" / "a.png") << "no picture";
  const auto refused = [&](std::vector<std::string> arguments, const std::string& with) {
    const CommandResult command = run(arguments);
    EXPECT_EQ(command.exit_code, 2);
    EXPECT_NE(command.err.find(with), std::string::npos) << command.err;
    EXPECT_EQ(std::count(command.err.begin(), command.err.end(), '\n'), 1) << command.err;
  };
  refused({"world", "moon"}, "no family of worlds 'moon'; there are room, corridor, warehouse");
  refused({"world", "room", "--pictures", "empty"}, "no picture (.png, .jpg, .jpeg, .bmp)");
  refused({"world", "room", "--pictures", "broken"}, "no picture that can be read");
  std::string huge("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x7d\0\0\0\x7d\0\x8\2\0\0\0",
                   29);  // 32000 x 32000
  std::ofstream(folder_.path() / "broken" / "a.png", std::ios::binary) << huge;
  refused({"world", "room", "--pictures", "broken"},
          "a.png: the picture has 32000 x 32000 pixels, and can have 67 million in all; give a");
  refused({"world", "room", "--out", "broken"}, "broken");
  refused({"suite", "--worlds", "dev"}, "no split 'dev'; give train, validate or test");
  refused({"suite", "--worlds", "train", "--family", "moon"}, "no family of worlds 'moon'");
  refused({"suite", "--count", "3"}, "--worlds");
  refused({"suite", "scenarios", "--worlds", "train"}, "PATH");
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
}

TEST_F(WorldCommand, ASuiteOfWorldsRunsEachOnceAndKeepsThem) {
  const std::vector<std::string> command{"suite",    "--worlds", "train", "--count", "2",
                                         "--family", "corridor", "--set", "frames=4"};
  const CommandResult first = run(command);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("= corridor (2"), std::string::npos) << first.out;
  const suite::SuiteResult result =
      suite::read_suite(folder_.path() / "out" / "suite" / suite::kSuiteFile);
  ASSERT_EQ(result.scenarios.size(), 2u);
  EXPECT_EQ(result.scenarios[0].name, "corridor_1");
  EXPECT_EQ(result.scenarios[0].runs.size(), 1u);
  ASSERT_TRUE(result.scenarios[0].drawn);
  EXPECT_EQ(result.scenarios[0].drawn->family, "corridor");
  EXPECT_GT(result.scenarios[0].drawn->features.size(), 2u);
}

TEST_F(WorldCommand, AKeptWorldThatWasEditedIsRefused) {
  const std::vector<std::string> command{"suite",    "--worlds", "train", "--count",  "1",
                                         "--family", "corridor", "--set", "frames=2", "--quiet"};
  ASSERT_EQ(run(command).exit_code, 0);
  const fs::path kept =
      (folder_.path() / suite::read_suite(folder_.path() / "out" / "suite").scenarios[0].file)
          .parent_path();
  ASSERT_EQ(run(command).exit_code, 0) << "it is used again";
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kept)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  ASSERT_GT(files.size(), 4u);
  for (const fs::path& file : files) {
    const std::string bytes = test::read(file);
    test::write(file, bytes + " ");
    const CommandResult edited = run(command);
    EXPECT_EQ(edited.exit_code, 2) << file;
    EXPECT_NE(edited.err.find("remove that folder"), std::string::npos) << edited.err;
    EXPECT_EQ(test::read(file), bytes + " ");
    fs::remove(file);
    EXPECT_EQ(run(command).exit_code, 2) << file << " is missing";
    test::write(file, bytes);
  }
  EXPECT_EQ(run(command).exit_code, 0);
}

TEST_F(WorldCommand, TwoSuitesThatNeedTheSameWorldsAtOnceBothRun) {
  const auto start = [&](const char* out) {
    return std::make_unique<test::Command>(
        std::vector<std::string>{"suite", "--worlds", "train", "--count", "2", "--family",
                                 "corridor", "--set", "frames=2", "--quiet", "--out", out},
        test::CommandOptions{.folder = folder_.path()});
  };
  const auto one = start("one"), other = start("other");
  for (test::Command* suite : {one.get(), other.get()}) {
    const CommandResult result = suite->wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
}

TEST_F(WorldCommand, ASuiteOfWorldsLeavesAPageToLookAtAndSaysWhatTheSplitIsFor) {
  const CommandResult command =
      run({"suite", "--worlds", "test", "--count", "2", "--family", "corridor", "--set", "frames=4",
           "--beside", "lcs:lab", "--beside", "klt"});
  ASSERT_EQ(command.exit_code, 0) << command.err;
  EXPECT_NE(command.out.find(" drawn again\n"), std::string::npos) << command.out;
  EXPECT_NE(command.out.find("The split test is to state figures: nothing is chosen by it"),
            std::string::npos)
      << command.out;
  const fs::path out = folder_.path() / "out" / "suite";
  EXPECT_EQ(test::entries(out / "worlds"),
            (std::set<std::string>{"corridor_2000000.jpg", "corridor_2000001.jpg"}));
  const std::string page = test::read(out / "worlds.html");
  for (const char* part :
       {"worlds/corridor_2000001.jpg", "<td>lcs:lab</td>", "<td>klt</td>",
        "report.html#corridor_2000001/seed-2000001", "runs/corridor_2000001/seed-2000001/"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  // It can be used like any earlier suite.
  fs::create_directory(folder_.path() / "scenarios");
  std::ofstream(folder_.path() / "scenarios" / "near.yaml")
      << "purpose: near\nscene: lab\nframes: 2\nego: {start: [-4 m, 0 m], speed: 0.5 m/s}\n"
         "camera: {size: [160, 120]}\n";
  const CommandResult again = run({"suite", "scenarios", "--seeds", "2"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(fs::exists(out / "worlds.html"));
  EXPECT_FALSE(fs::exists(out / "worlds"));
}

/// A world of `test`, and one of `train` to show that only the split is refused.
class WorldOfSplit : public WorldCommand, public testing::WithParamInterface<std::uint64_t> {
 protected:
  WorldOfSplit() {
    EXPECT_EQ(run({"world", "corridor", "--seed", seed(), "--out", "w"}).exit_code, 0);
  }
  static std::string seed() { return std::to_string(GetParam()); }
  fs::path world() const { return folder_.path() / "w" / ("corridor_" + seed() + ".yaml"); }

  void make_suite(const std::string& of, std::vector<std::string> more = {}) {
    fs::remove_all(folder_.path() / "s");
    std::vector<std::string> arguments{"suite", of, "--out", "s", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult made = run(arguments);
    ASSERT_LE(made.exit_code, 1) << made.err;
  }
  void expect_refused_or_not(const char* way) {
    const CommandResult tuned = run(
        {"tune", "s", "--evaluations", "1", "--keys", "hypotheses.prior", "--out", "t", "--quiet"});
    if (GetParam() < 2'000'000) {
      EXPECT_EQ(tuned.exit_code, 0) << way << ": " << tuned.err;
      fs::remove_all(folder_.path() / "t");
      return;
    }
    EXPECT_EQ(tuned.exit_code, 2) << way;
    EXPECT_NE(tuned.err.find("is of the split test (world corridor 2000000)"), std::string::npos)
        << way << ": " << tuned.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "t")) << way;
  }
  /// Copies the world's YAML without the lines that begin with `begins` to a file beside it.
  void copy_without(const std::vector<std::string>& begins, const std::string& name,
                    const std::string& added = "") {
    std::istringstream lines(test::read(world()));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      const bool is_out = std::any_of(begins.begin(), begins.end(), [&](const std::string& begin) {
        return line.starts_with(begin);
      });
      if (!is_out) text += line + '\n';
    }
    test::write(folder_.path() / "w" / name, text + added);
  }
};
INSTANTIATE_TEST_SUITE_P(TrainAndTest, WorldOfSplit, testing::Values(1, 2'000'000));

const std::vector<std::string> kBrief{"--set", "frames=4"};
const std::vector<std::string> kOrigin{
    "#", "origin:", "  family:", "  seed:", "  again:", "  features:"};

TEST_P(WorldOfSplit, StaysOneOfItByAnyNameAndSeed) {
  make_suite("w", kBrief);
  expect_refused_or_not("as it is");
  copy_without({"#", "seed:"}, "mine.yaml", "seed: 5\n");
  make_suite("w/mine.yaml", {"--set", "frames=4", "--seeds", "2"});
  expect_refused_or_not("a copy with seeds of its own");
  copy_without(kOrigin, "plain.yaml", "");
  make_suite("w/plain.yaml", {"--set", "frames=4", "--set", "seed=3"});
  expect_refused_or_not("without its origin: the scene has it");
}

TEST_P(WorldOfSplit, StaysOneOfItInAnotherScenarioAndASceneOfItsOwn) {
  test::write(folder_.path() / "other" / "drive.yaml",
              "scene: ../w/scene.xml\nframes: 4\nego: {start: [0 m, 0 m], speed: 0.3 m/s}\n"
              "camera: {size: [160, 120]}\n");
  make_suite("other");
  expect_refused_or_not("another scenario");
  test::write(folder_.path() / "w" / "own.xml",
              "<mujoco><include file='scene.xml'/></mujoco>");  // its textures are there
  test::write(folder_.path() / "other" / "drive.yaml",
              "scene: ../w/own.xml\nframes: 4\nego: {start: [0 m, 0 m], speed: 0.3 m/s}\n"
              "camera: {size: [160, 120]}\n");
  make_suite("other");
  expect_refused_or_not("a scene that includes it");
}

TEST_P(WorldOfSplit, StaysOneOfItAsARecording) {
  const CommandResult made = run({"generate", world().string(), "--set", "frames=4", "--formats",
                                  "euroc,landmarks,mot", "--out", "seq", "--quiet"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const fs::path recorded = folder_.path() / "recorded" / "drive.yaml";
  test::write(recorded, "recording: {path: ../seq}\n");
  make_suite("recorded");
  expect_refused_or_not("a sequence");
  const CommandResult watched =
      run({"suite", "recorded", "--recorded", "s", "--out", "again", "--quiet"});
  ASSERT_LE(watched.exit_code, 1) << watched.err;
  fs::remove_all(folder_.path() / "s");
  fs::rename(folder_.path() / "again", folder_.path() / "s");
  expect_refused_or_not("an earlier run of a sequence");
  test::write(recorded,
              "recording: {path: ../seq/mav0/cam0/data, focal: 300 px, speed: 0 m/s, "
              "nothing_moves: true}\n");
  make_suite("recorded");
  expect_refused_or_not("pictures of a sequence");
  // A sequence from before the entry of the origin.
  const fs::path settings = folder_.path() / "seq" / "lcs.json";
  std::string text = test::read(settings);
  const std::size_t at = text.find(",\n  \"origin\"");
  ASSERT_NE(at, std::string::npos);
  test::write(settings, text.substr(0, at) + "\n}\n");
  test::write(recorded, "recording: {path: ../seq}\n");
  make_suite("recorded");
  expect_refused_or_not("a sequence of old");
}

TEST_P(WorldOfSplit, OfOldIsKnownByItsName) {
  make_suite("w", kBrief);
  const fs::path truth = folder_.path() / "s" /
                         suite::read_suite(folder_.path() / "s").scenarios[0].runs[0].folder /
                         "truth.jsonl";
  std::string text = input::read_file(truth.string() + ".gz", {input::kGibibyte, ""});
  const std::string origin = ",\"origin\":{\"family\":\"corridor\",\"seed\":" + seed() + "}";
  const std::size_t at = text.find(origin);
  ASSERT_NE(at, std::string::npos);
  test::write(truth, text.erase(at, origin.size()));
  expect_refused_or_not("by its name");
}

TEST_P(WorldOfSplit, WithAnotherOriginThanItsSceneIsRefused) {
  for (const char* set : {"origin.seed=5", "origin={family: corridor, seed: 5}"}) {
    const CommandResult other = run(
        {"run", world().string(), "--no-video", "--set", "frames=4", "--set", set, "--out", "r"});
    EXPECT_EQ(other.exit_code, 2) << set;
    EXPECT_NE(other.err.find("origin is corridor 5, but the scene"), std::string::npos)
        << other.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "r"));
  }
}

TEST_F(WorldCommand, ItsOriginChangesNoPicture) {
  ASSERT_EQ(run({"world", "corridor", "--seed", "4", "--out", "w"}).exit_code, 0);
  const fs::path with = folder_.path() / "w", without = folder_.path() / "without";
  fs::copy(with, without, fs::copy_options::recursive);
  std::string scene = test::read(without / "scene.xml");
  const std::size_t begin = scene.find("  <custom>"), end = scene.find("  <compiler");
  ASSERT_LT(begin, end);
  test::write(without / "scene.xml", scene.erase(begin, end - begin));
  std::string yaml = test::read(without / "corridor_4.yaml");
  test::write(without / "corridor_4.yaml",
              yaml.erase(yaml.find("origin:"), yaml.find("\nseed:") + 1 - yaml.find("origin:")));
  for (const char* folder : {"w", "without"}) {
    const CommandResult made =
        run({"generate", std::string(folder) + "/corridor_4.yaml", "--set", "frames=3", "--formats",
             "euroc,landmarks", "--out", std::string("of_") + folder, "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  const auto one = test::bytes_in(folder_.path() / "of_w");
  auto other = test::bytes_in(folder_.path() / "of_without");
  for (const auto& [path, bytes] : one) {
    const bool tells_of_it = path == "lcs.json" || path == "scenario.yaml" ||
                             path == "manifest.json" || path == ".lcs-written";
    EXPECT_TRUE(tells_of_it || bytes == other[path]) << path;
  }
}

}  // namespace
}  // namespace lcs::worlds
