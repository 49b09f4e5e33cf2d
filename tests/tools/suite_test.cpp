// `lcs suite` from its command line to its files, on short scenarios with small images.
#include <gtest/gtest.h>
#include <signal.h>
#include <tinyxml2.h>

#include <chrono>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/processes.h"
#include "tests/tools/suites.h"
#include "tests/tools/temporary_folder.h"
#include "tools/scoring/figures_file.h"
#include "tools/suite/suite_result.h"
#include "tools/suite/tables.h"

namespace lcs::suite {
namespace {

namespace fs = std::filesystem;
using test::children_of;
using test::CommandResult;
using test::entries;
using test::read;

class Suite : public testing::Test {
 protected:
  /// Writes a scenario with a small image and additional keys.
  void scenario(const std::string& name, const std::string& more = "", int frames = 4) {
    fs::create_directories(folder_.path() / "scenarios");
    std::ofstream(folder_.path() / "scenarios" / (name + ".yaml"))
        << "purpose: " << name << "\nscene: lab\nframes: " << frames
        << "\nego: {start: [-4 m, 0 m], speed: 0.5 m/s}\ncamera: {size: [160, 120]}\n"
        << more;
  }
  CommandResult run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"suite", "scenarios"});
    return test::run_lcs(arguments, {.folder = folder_.path()});
  }
  SuiteResult result(const fs::path& out = "out/suite") {
    return read_suite(folder_.path() / out / kSuiteFile);
  }
  /// The folder of a run.
  fs::path run_folder(const ScenarioResult& scenario, std::size_t place) {
    return folder_.path() / "out" / "suite" / scenario.runs.at(place).folder;
  }

  const test::TemporaryFolder folder_;
  const fs::path out_ = folder_.path() / "out" / "suite";
};

TEST_F(Suite, RunsEveryScenarioOfAFolderWithItsSeedsAndSumsThemUp) {
  scenario("near", "seed: 7\n");
  scenario("far");
  const CommandResult command = run({"--seeds", "2"});
  ASSERT_EQ(command.exit_code, 0) << command.err;
  EXPECT_EQ(entries(folder_.path() / "out"), std::set<std::string>{"suite"});
  EXPECT_EQ(entries(out_),
            (std::set<std::string>{"suite.json", "junit.xml", "report.html", "runs", "run.json"}));

  const SuiteResult suite = result();
  EXPECT_EQ(suite.detector, "lcs");
  EXPECT_NE(suite.version.find("MuJoCo"), std::string::npos) << suite.version;
  ASSERT_EQ(suite.scenarios.size(), 2u);
  EXPECT_EQ(suite.scenarios[0].name, "far");
  const ScenarioResult& near = suite.scenarios[1];
  EXPECT_EQ(near.name, "near");
  EXPECT_EQ(near.purpose, "near");
  EXPECT_EQ(near.file, fs::path("scenarios") / "near.yaml");
  EXPECT_EQ(near.groups, std::vector<std::string>{"short"});
  EXPECT_TRUE(near.point.empty());
  ASSERT_EQ(near.runs.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(near.runs[i].seed, 7 + i);
    EXPECT_EQ(near.runs[i].outcome, Outcome::passed);
    EXPECT_GT(near.runs[i].wall_s, 0);
    EXPECT_EQ(near.runs[i].metrics,
              scoring::read_metrics(run_folder(near, i) / scoring::kMetricsFile));
  }
  for (const char* part : {"near", "far", "= short (2, 0 with F1)", "4 runs without an error",
                           "4 runs of 2 scenarios: 4 passed, 0 failed"}) {
    EXPECT_NE(command.out.find(part), std::string::npos) << part << " in\n" << command.out;
  }
  EXPECT_NE(command.err.find("[run 4/4]"), std::string::npos) << command.err;
}

TEST_F(Suite, AFilterAGroupAndANamedFileChooseWhatIsRun) {
  scenario("near");
  scenario("far");
  scenario("endless", "groups: [long]\n");
  const auto listed = [&](std::vector<std::string> arguments) {
    arguments.emplace_back("--list");
    return test::run_lcs(arguments, {.folder = folder_.path()}).out;
  };
  const auto has = [](const std::string& text, const char* name) {
    return text.find(name) != std::string::npos;
  };
  const std::string shorts = listed({"suite", "scenarios", "--group", "short"});
  EXPECT_TRUE(has(shorts, "near") && has(shorts, "far") && !has(shorts, "endless")) << shorts;
  const std::string longs = listed({"suite", "scenarios", "--group", "long"});
  EXPECT_TRUE(!has(longs, "near") && has(longs, "endless")) << longs;
  const std::string all = listed({"suite", "scenarios"});
  EXPECT_TRUE(has(all, "near") && has(all, "endless")) << "of an own folder all are meant: " << all;
  const std::string filtered = listed({"suite", "scenarios", "--filter", "^n.a"});
  EXPECT_TRUE(has(filtered, "near") && !has(filtered, "far")) << filtered;
  const std::string named = listed({"suite", "scenarios/endless.yaml"});
  EXPECT_TRUE(has(named, "endless")) << "a file that is named is meant, whatever its group";
  const std::string shipped = listed({"suite"});
  EXPECT_TRUE(has(shipped, "crossing") && has(shipped, "lab") && !has(shipped, "[sweep]"))
      << shipped;
  EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"scenarios"}) << "nothing was run";
}

TEST_F(Suite, ACriterionThatIsNotMetIsAFailureAndExitsWithOne) {
  scenario("near",
           "criteria:\n  - {metric: frames, min: 4}\n  - {metric: frames, min: 5}\n"
           "  - {metric: frames, min: 6, required: false}\n");
  scenario("far");
  const CommandResult command = run({"--seeds", "1", "--quiet"});
  EXPECT_EQ(command.exit_code, 1);
  EXPECT_EQ(command.out, "");
  EXPECT_NE(command.err.find("failed: near seed 1: scenarios/near.yaml:8: frames is 4, must be at "
                             "least 5\n"),
            std::string::npos)
      << command.err;
  EXPECT_NE(command.err.find("missed (not required): near"), std::string::npos) << command.err;

  const ScenarioResult near = result().scenarios[1];
  EXPECT_EQ(near.runs[0].outcome, Outcome::failed);
  ASSERT_EQ(near.runs[0].criteria.size(), 3u);
  EXPECT_TRUE(near.runs[0].criteria[0].met);
  EXPECT_EQ(near.runs[0].criteria[0].value, 4);
  EXPECT_FALSE(near.runs[0].criteria[1].met);
  EXPECT_FALSE(near.runs[0].criteria[2].met);
  EXPECT_EQ(result().scenarios[0].runs[0].outcome, Outcome::passed);
}

TEST_F(Suite, ACriterionOverSeedsIsJudgedOnceForAllOfThem) {
  scenario("near",
           "criteria: [{metric: frames, min: 5, over: mean}, {metric: frames, min: 4, over: "
           "interval}]\n");
  const CommandResult command = run({"--seeds", "2", "--quiet"});
  EXPECT_EQ(command.exit_code, 1);
  EXPECT_NE(command.err.find("failed: near: scenarios/near.yaml:6: frames is 4, the mean over 2 "
                             "seeds, must be at least 5\n"),
            std::string::npos)
      << command.err;
  EXPECT_EQ(std::count(command.err.begin(), command.err.end(), '\n'), 1) << command.err;
  const CommandResult single = test::run_lcs(
      {"run", "scenarios/near.yaml", "--no-video", "--quiet"}, {.folder = folder_.path()});
  EXPECT_EQ(single.exit_code, 0);
  EXPECT_NE(single.err.find("not judged: criteria over seeds"), std::string::npos) << single.err;
}

TEST_F(Suite, ABrokenScenarioIsAnErrorAndTheOthersStillRun) {
  scenario("broken", "camra: {}\n");
  scenario("falling", "actors: {ghost: {body: nobody, trajectory: {still: {}}}}\n");
  scenario("near");
  const CommandResult command = run({"--seeds", "2"});
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_NE(command.err.find("error: broken: scenarios/broken.yaml:6: "), std::string::npos)
      << command.err;
  EXPECT_NE(command.err.find("error: falling seed 1, 2: scenarios/falling.yaml:6: "),
            std::string::npos)
      << command.err;
  const SuiteResult suite = result();
  ASSERT_EQ(suite.scenarios.size(), 3u);
  EXPECT_EQ(suite.scenarios[0].runs[0].outcome, Outcome::error);
  EXPECT_NE(suite.scenarios[0].runs[0].error.find("camera"), std::string::npos) << "and the remedy";
  EXPECT_EQ(suite.scenarios[1].runs[1].outcome, Outcome::error);
  EXPECT_TRUE(suite.scenarios[1].runs[1].metrics.empty());
  EXPECT_EQ(suite.scenarios[2].runs[1].outcome, Outcome::passed);
  EXPECT_EQ(entries(out_ / "runs"), std::set<std::string>{"near"});
}

TEST_F(Suite, ASweepIsOneScenarioAPoint) {
  scenario("speeds", "sweep: {ego.speed: [0.1 m/s, 0.9 m/s], camera.rate: [5 Hz, 10 Hz]}\n");
  ASSERT_EQ(run({"--seeds", "1"}).exit_code, 0);
  const SuiteResult suite = result();
  ASSERT_EQ(suite.scenarios.size(), 4u);
  std::set<std::string> names, figures;
  for (const ScenarioResult& point : suite.scenarios) {
    names.insert(point.name);
    ASSERT_EQ(point.point.size(), 2u);
    EXPECT_EQ(point.point[0].first, "ego.speed");
    figures.insert(read(run_folder(point, 0) / "truth.jsonl.gz"));
  }
  EXPECT_EQ(names, (std::set<std::string>{"speeds@0.1mps,5Hz", "speeds@0.1mps,10Hz",
                                          "speeds@0.9mps,5Hz", "speeds@0.9mps,10Hz"}));
  EXPECT_EQ(figures.size(), 4u) << "the points reach the runs";
  EXPECT_EQ(suite.scenarios[0].runs[0].command,
            "lcs run scenarios/speeds.yaml --seed 1 --set 'ego.speed=0.1 m/s' --set "
            "'camera.rate=5 Hz'");
}

/// The result without times.
nlohmann::ordered_json timeless(const fs::path& file) {
  auto json = nlohmann::ordered_json::parse(read(file));
  for (auto& scenario : json["scenarios"]) {
    for (auto& run : scenario["runs"]) {
      run.erase("wall_s");
      run.erase("command");  // a run of recorded frames has another command
      auto& metrics = run["metrics"];
      for (auto metric = metrics.begin(); metric != metrics.end();) {
        const bool is_time = metric.key().starts_with("time.") || metric.key().starts_with("sim.");
        metric = is_time ? metrics.erase(metric) : std::next(metric);
      }
    }
  }
  return json;
}

TEST_F(Suite, OnTheFramesOfAnEarlierOneItHasTheFiguresOfOneThatSimulates) {
  const char* const kSetting = "filter.hypotheses.neighbours=4";
  scenario("near", "", 8);
  scenario("speeds", "sweep: {ego.speed: [0.1 m/s, 0.9 m/s]}\n", 8);
  ASSERT_EQ(run({"--seeds", "2", "--out", "first"}).exit_code, 0);
  ASSERT_EQ(run({"--seeds", "2", "--out", "live", "--set", kSetting}).exit_code, 0);
  const CommandResult again =
      run({"--seeds", "2", "--out", "again", "--set", kSetting, "--recorded", "first"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  auto figures = timeless(folder_.path() / "again" / kSuiteFile);
  const std::string recorded = figures["recorded"];
  EXPECT_EQ(recorded, "first, " + result("first").version);
  EXPECT_EQ(result("again").recorded, recorded);
  EXPECT_NE(read(folder_.path() / "again" / "report.html").find(recorded), std::string::npos);
  figures["recorded"] = "";
  EXPECT_EQ(figures, timeless(folder_.path() / "live" / kSuiteFile));

  // A run that is missing in the earlier suite is an error, and the others still run.
  const CommandResult more =
      run({"--seeds", "3", "--filter", "near", "--out", "more", "--recorded", "first"});
  EXPECT_EQ(more.exit_code, 2);
  EXPECT_NE(more.err.find("error: near seed 3: there is no run in first/runs/near/seed-3"),
            std::string::npos)
      << more.err;
  EXPECT_EQ(result("more").scenarios.at(0).runs.at(1).outcome, Outcome::passed);
}

TEST_F(Suite, RunsOtherDetectorsBesideOnTheSameFramesAndLeavesTheirsAsSuites) {
  // The first criterion applies to the filter, not to the other detectors, which have no layers.
  scenario("near",
           "criteria:\n  - {metric: dimension.mean, min: 1}\n"
           "  - {metric: frames, max: 7, detector: klt}\n"
           "  - {metric: frames, max: 7, detector: 'lcs:cars'}\n",
           8);
  const CommandResult command =
      run({"--seeds", "2", "--beside", "klt", "--beside", "dis", "--format", "csv"});
  EXPECT_EQ(command.exit_code, 1) << command.err;
  for (const char* table : {"scenario,rebel.precision", "\ndetector,rebel.recall"}) {
    EXPECT_NE(command.out.find(table), std::string::npos) << command.out;
  }
  EXPECT_NE(command.err.find("klt: failed: near seed 2: "), std::string::npos) << command.err;
  EXPECT_NE(command.err.find("frames of klt is 8, must be at most 7"), std::string::npos);
  const std::string not_asked = "not asked: criteria of lcs:cars (scenarios/near.yaml:9)";
  EXPECT_NE(command.err.find(not_asked), std::string::npos) << command.err;
  EXPECT_EQ(command.err.find(not_asked), command.err.rfind(not_asked)) << "told once";
  tinyxml2::XMLDocument junit;
  ASSERT_EQ(junit.LoadFile((out_ / kJunitFile).c_str()), tinyxml2::XML_SUCCESS);
  EXPECT_EQ(junit.RootElement()->IntAttribute("tests"), 4);
  EXPECT_EQ(junit.RootElement()->IntAttribute("failures"), 2);
  const auto* of_klt = junit.RootElement()->FirstChildElement()->LastChildElement();
  EXPECT_STREQ(of_klt->Attribute("name"), "klt: frames max, seed 2");
  EXPECT_EQ(entries(out_), (std::set<std::string>{"suite.json", "junit.xml", "report.html", "runs",
                                                  "run.json", "beside", "standing.md"}));
  EXPECT_NE(command.err.find("[run 2/2] near seed "), std::string::npos) << command.err;
  EXPECT_EQ(result().detector, "lcs");
  for (const std::string name : {"klt", "dis"}) {
    const fs::path beside = fs::path("out") / "suite" / "beside" / name;
    const SuiteResult other = result(beside);
    EXPECT_EQ(other.detector, name);
    ASSERT_EQ(other.scenarios.size(), 1u);
    ASSERT_EQ(other.scenarios[0].runs.size(), 2u);
    const RunResult& run = other.scenarios[0].runs[1];
    EXPECT_EQ(run.outcome, name == "klt" ? Outcome::failed : Outcome::passed);
    EXPECT_TRUE(fs::equivalent(folder_.path() / beside / run.folder / "truth.jsonl.gz",
                               run_folder(result().scenarios[0], 1) / "truth.jsonl.gz"))
        << "one file has the truth of both";
  }
  // It can be used like any earlier suite.
  EXPECT_EQ(run({"--seeds", "2"}).exit_code, 0) << "klt is not asked";
  EXPECT_FALSE(fs::exists(out_ / "beside"));
}

TEST_F(Suite, APresetBesideHasTheFiguresOfTheFilterWithThatPresetAlone) {
  scenario("near", "filter: {preset: cars, circle.mu_0: 20}\n", 8);
  const std::vector<std::string> command{"--seeds", "1", "--beside", "lcs:lab"};
  const CommandResult beside = run(command);
  ASSERT_EQ(beside.exit_code, 0) << beside.err;
  const SuiteResult lab = result(fs::path("out") / "suite" / "beside" / "lcs:lab");
  EXPECT_EQ(lab.detector, "lcs:lab");

  scenario("near", "filter: {preset: lab}\n", 8);
  ASSERT_EQ(run({"--seeds", "1", "--out", "plain"}).exit_code, 0);
  const fs::path plain =
      folder_.path() / "plain" / result("plain").scenarios.at(0).runs.at(0).folder;
  const fs::path own = out_ / "beside" / "lcs:lab" / lab.scenarios.at(0).runs.at(0).folder;
  EXPECT_TRUE(read(own / "layers.jsonl.gz") == read(plain / "layers.jsonl.gz"));
  EXPECT_FALSE(read(own / "layers.jsonl.gz") ==
               read(out_ / lab.scenarios.at(0).runs.at(0).folder / "layers.jsonl.gz"));
}

TEST_F(Suite, ADetectorBesideThatIsUnknownOrRunAlreadyIsRefused) {
  scenario("near");
  for (const auto& [name, said] : {std::pair{"lcs", "it is run already"},
                                   {"orb", "no detector"},
                                   {"lcs:orb", "no preset 'orb'"},
                                   {"klt:lab", "klt has no presets"}}) {
    const CommandResult command = run({"--beside", name});
    EXPECT_EQ(command.exit_code, 2);
    EXPECT_NE(command.err.find(said), std::string::npos) << command.err;
  }
  EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"scenarios"});
}

TEST_F(Suite, AnEarlierOneThatIsNoneOrADetectorThatLooksIsRefusedBeforeAnythingRuns) {
  scenario("near");
  const CommandResult missing = run({"--recorded", "nowhere"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.err.find("nowhere: there is no such file; "), std::string::npos) << missing.err;
  const CommandResult klt = run({"--recorded", "nowhere", "--detector", "klt"});
  EXPECT_EQ(klt.exit_code, 2);
  EXPECT_NE(klt.err.find("klt looks at the pictures"), std::string::npos) << klt.err;
  EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"scenarios"});
}

TEST_F(Suite, HasTheSameFiguresHoweverManyRunAtATime) {
  for (const char* name : {"a", "b", "c"}) scenario(name);
  ASSERT_EQ(run({"--seeds", "2", "--jobs", "1", "--out", "one"}).exit_code, 0);
  ASSERT_EQ(run({"--seeds", "2", "--jobs", "3", "--out", "three"}).exit_code, 0);
  const auto one = timeless(folder_.path() / "one" / kSuiteFile);
  EXPECT_EQ(one, timeless(folder_.path() / "three" / kSuiteFile));
  EXPECT_TRUE(one["scenarios"][0]["runs"][0]["metrics"].contains("dimension.mean"));
}

TEST_F(Suite, KeepsNoMoreThanIsAskedForWithTheSameFigures) {
  scenario("near");
  ASSERT_EQ(run({"--seeds", "1", "--out", "all", "--beside", "klt"}).exit_code, 0);
  ASSERT_EQ(run({"--seeds", "1", "--out", "few", "--beside", "klt", "--keep", "events"}).exit_code,
            0);
  ASSERT_EQ(
      run({"--seeds", "1", "--out", "none", "--beside", "klt", "--keep", "figures"}).exit_code, 0);
  EXPECT_EQ(entries(folder_.path() / "few/runs/near/seed-1"),
            (std::set<std::string>{"events.json", "frames.csv", "metrics.json", "run.json",
                                   "warnings.json"}));
  EXPECT_EQ(entries(folder_.path() / "none"),
            (std::set<std::string>{"beside", "junit.xml", "report.html", "run.json", "standing.md",
                                   "suite.json"}));
  EXPECT_EQ(entries(folder_.path() / "none/beside/klt"), std::set<std::string>{"suite.json"});
  for (const char* suite : {"few", "none"}) {
    SCOPED_TRACE(suite);
    const auto figures = [&](const std::string& folder) {
      return timeless(folder_.path() / folder / kSuiteFile)["scenarios"][0]["runs"][0]["metrics"];
    };
    EXPECT_EQ(figures(suite), figures("all"));
    const CommandResult again = run({"--seeds", "1", "--recorded", suite, "--out", "again"});
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_NE(again.err.find("--keep all"), std::string::npos) << again.err;
  }
}

TEST_F(Suite, SettingsReachEveryRunAndAreWrittenDown) {
  scenario("near");
  ASSERT_EQ(run({"--seeds", "1", "--set", "frames=3"}).exit_code, 0);
  const SuiteResult suite = result();
  EXPECT_EQ(suite.sets, std::vector<std::string>{"frames=3"});
  EXPECT_EQ(suite.scenarios[0].runs[0].metrics[0],
            (std::pair<std::string, std::optional<double>>{"frames", 3}));
}

TEST_F(Suite, ARunPassesOnlyWhatItCanBeJudgedByAlone) {
  scenario("alone", "criteria: [{metric: frames, min: 4}]\n");
  scenario("never", "");
  scenario("together", "criteria: [{metric: frames, min: 5, over: mean}]\n");
  const CommandResult result = run({"--seeds", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("alone seed 1: passed"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("never seed 1: done"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("together seed 1: done"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("2 passed, 1 failed"), std::string::npos) << result.out;
}

TEST_F(Suite, ADetectorReachesEveryRunAndIsWrittenDown) {
  scenario("near");
  ASSERT_EQ(run({"--seeds", "1", "--detector", "klt"}).exit_code, 0);
  EXPECT_EQ(result().detector, "klt");
}

TEST_F(Suite, ABaselineShowsChangesAndAnUnreadableOneIsRefusedBeforeAnyRun) {
  scenario("near");
  ASSERT_EQ(run({"--seeds", "2", "--out", "before"}).exit_code, 0);
  const CommandResult same =
      run({"--seeds", "2", "--recorded", "before", "--baseline", "before", "--fail-on-regression"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_NE(same.out.find("\nequal: no loss above "), std::string::npos) << same.out;

  // A better earlier suite: an unchanged result has regressed from it.
  const fs::path better = folder_.path() / "better";
  fs::copy(folder_.path() / "before", better, fs::copy_options::recursive);
  SuiteResult suite = read_suite(better);
  for (RunResult& run : suite.scenarios[0].runs) {
    for (auto& [name, figure] : run.metrics) {
      if (name == "rebel.false_corners_per_frame") figure = figure.value() - 50;
    }
  }
  write_suite(better / kSuiteFile, suite);
  const std::vector<std::string> against{"--seeds", "2",          "--recorded",
                                         "before",  "--baseline", "better"};
  const CommandResult worse = run(against);
  EXPECT_EQ(worse.exit_code, 0) << "it is not asked to fail";
  EXPECT_NE(worse.out.find("passed, regressed: near\n  rebel.false_corners_per_frame "),
            std::string::npos)
      << worse.out;
  EXPECT_NE(worse.out.find("\nregressed: rebel.false_corners_per_frame "), std::string::npos)
      << worse.out;
  std::vector<std::string> strict = against;
  strict.insert(strict.end(), {"--fail-on-regression", "--quiet"});
  const CommandResult failed = run(strict);
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_NE(failed.err.find("against better: regressed: rebel.false_corners_per_frame "),
            std::string::npos)
      << failed.err;

  const CommandResult missing = run({"--baseline", "no_such", "--out", "other"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.err.find("no_such"), std::string::npos) << missing.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "other"));
}

TEST_F(Suite, AnEarlierSuiteIsReplacedAsAWhole) {
  scenario("near");
  scenario("far");
  ASSERT_EQ(run({"--seeds", "1"}).exit_code, 0);
  const CommandResult fewer = run({"--seeds", "1", "--filter", "near"});
  EXPECT_EQ(fewer.exit_code, 2);
  EXPECT_NE(fewer.err.find("holds a result of 2 runs, and this one has 1"), std::string::npos)
      << fewer.err;
  ASSERT_EQ(run({"--seeds", "2", "--filter", "near"}).exit_code, 0);
  EXPECT_EQ(result().scenarios.size(), 1u);
  EXPECT_EQ(entries(out_ / "runs"), std::set<std::string>{"near"});
  EXPECT_EQ(entries(folder_.path() / "out"), std::set<std::string>{"suite"});
}

TEST_F(Suite, AFolderThatHoldsAnythingElseIsRefusedAndUntouched) {
  scenario("near");
  ASSERT_EQ(run({"--seeds", "1"}).exit_code, 0);
  const fs::path precious = out_ / "runs" / "near" / "seed-1" / "thesis.tex";
  std::ofstream(precious) << "precious";
  const std::string before = read(out_ / kSuiteFile);
  const CommandResult command = run({"--seeds", "1"});
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_NE(command.err.find("thesis.tex"), std::string::npos) << command.err;
  EXPECT_EQ(read(precious), "precious");
  EXPECT_EQ(read(out_ / kSuiteFile), before);
}

struct Mistake {
  const char* name;
  std::vector<std::string> arguments;
  const char* said;
};

class SuiteMistake : public Suite, public testing::WithParamInterface<Mistake> {};

TEST_P(SuiteMistake, IsToldInOneLineWithExitCodeTwoBeforeAnythingRuns) {
  scenario("near");
  const CommandResult command = run(GetParam().arguments);
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_EQ(command.out, "");
  EXPECT_EQ(std::count(command.err.begin(), command.err.end(), '\n'), 1) << command.err;
  EXPECT_NE(command.err.find(GetParam().said), std::string::npos) << command.err;
  EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"scenarios"});
}

INSTANTIATE_TEST_SUITE_P(
    All, SuiteMistake,
    testing::Values(Mistake{"no_such_path", {"no_such"}, "no_such"},
                    Mistake{"nothing_fits", {"--filter", "moon"}, "the groups are short"},
                    Mistake{"no_such_group", {"--group", "nightly"}, "the groups are short"},
                    Mistake{"bad_filter", {"--filter", "("}, "regular expression"},
                    Mistake{"no_seeds", {"--seeds", "0"}, "--seeds"},
                    Mistake{"no_baseline", {"--fail-on-regression"}, "--baseline"},
                    Mistake{"no_jobs", {"--jobs", "0"}, "--jobs"},
                    Mistake{"no_such_kind", {"--keep", "half"}, "figures, events or all"},
                    Mistake{"no_such_part", {"--shard", "3/2"}, "--shard"},
                    Mistake{"more_parts_than_runs", {"--shard", "1/9"}, "only 3 runs"},
                    Mistake{"unknown_detector", {"--detector", "yolo"}, "yolo"},
                    Mistake{"unwritable_folder", {"--out", "/proc/lcs"}, "/proc/lcs"}),
    [](const auto& test) { return test.param.name; });

TEST_F(Suite, TwoScenariosOfOneNameAreRefused) {
  scenario("near");
  fs::create_directories(folder_.path() / "scenarios" / "more");
  fs::copy_file(folder_.path() / "scenarios" / "near.yaml",
                folder_.path() / "scenarios" / "more" / "near.yaml");
  const CommandResult command = run({});
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_NE(command.err.find("both called near; rename"), std::string::npos) << command.err;
}

// ---- JUnit

TEST_F(Suite, ConsoleReportAndJUnitGiveTheSameCounts) {
  scenario("broken", "camra: {}\n");
  scenario("calm");
  scenario("near",
           "criteria:\n  - {metric: frames, min: 4}\n  - {metric: frames, min: 5}\n"
           "  - {metric: frames, min: 6, required: false}\n"
           "  - {metric: frames, min: 7, over: mean}\n"
           "  - {metric: frames, max: 3, detector: klt}\n");
  const CommandResult command = run({"--seeds", "2", "--beside", "klt"});
  EXPECT_EQ(command.exit_code, 2) << command.err;
  // Each of two seeds meets one, fails one and one of klt, and misses one; one fails over seeds;
  // two runs are calm, and one is broken.
  const std::string line =
      "4 of 12 criteria met, 5 failed, 2 missed but not required, 1 run with "
      "an error";
  const std::string runs = "5 runs of 3 scenarios: 2 passed, 2 failed, 1 with an error";
  EXPECT_NE(command.out.find("\n" + line + "\n" + runs + "; results in "), std::string::npos)
      << command.out;
  EXPECT_EQ(command.out.find("\x1b["), std::string::npos) << "no colour without a terminal";

  const std::string page = read(out_ / "report.html");
  const std::string before = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(before) + before.size();
  const auto data =
      nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(data.at("verdict"), line);
  EXPECT_EQ(data.at("run_counts"), runs);
  EXPECT_EQ(data.at("light"), "red");
  std::map<std::string, int> badges;
  for (const auto& one : data.at("scenarios")) ++badges[one.at("standings").at(0)];
  EXPECT_EQ(badges, (std::map<std::string, int>{{"error", 1}, {"failed", 1}, {"passed", 1}}));

  tinyxml2::XMLDocument junit;
  ASSERT_EQ(junit.LoadFile((out_ / kJunitFile).c_str()), tinyxml2::XML_SUCCESS);
  EXPECT_EQ(junit.RootElement()->IntAttribute("tests"), 12);
  EXPECT_EQ(junit.RootElement()->IntAttribute("failures"), 5);
  EXPECT_EQ(junit.RootElement()->IntAttribute("skipped"), 2);
  EXPECT_EQ(junit.RootElement()->IntAttribute("errors"), 1);

  EXPECT_NE(
      read(out_ / "standing.md").find("Means over 3 scenarios; F1 and recall over the 0 with F1"),
      std::string::npos);
}

TEST_F(Suite, JUnitHasACaseACriterionWithFailuresAndErrorsApart) {
  scenario("broken", "camra: {}\n");
  scenario("calm");
  scenario("near",
           "criteria:\n  - {metric: frames, min: 4}\n  - {metric: frames, min: 5, max: 9}\n"
           "  - {metric: frames, min: 6, required: false}\n");
  ASSERT_EQ(run({"--seeds", "2"}).exit_code, 2);
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.LoadFile((out_ / kJunitFile).c_str()), tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement* root = document.RootElement();
  ASSERT_STREQ(root->Name(), "testsuites");
  EXPECT_EQ(root->IntAttribute("tests"), 1 + 2 + 6);
  EXPECT_EQ(root->IntAttribute("failures"), 2);
  EXPECT_EQ(root->IntAttribute("errors"), 1);

  double total_s = 0;
  for (const auto* suite = root->FirstChildElement(); suite; suite = suite->NextSiblingElement()) {
    ASSERT_STREQ(suite->Name(), "testsuite");
    int tests = 0, failures = 0, errors = 0;
    double time_s = 0;
    for (const auto* test = suite->FirstChildElement(); test; test = test->NextSiblingElement()) {
      ASSERT_STREQ(test->Name(), "testcase");
      EXPECT_EQ(test->Attribute("file"),
                "scenarios/" + std::string(suite->Attribute("name")) + ".yaml");
      EXPECT_EQ(test->Attribute("classname"), "lcs." + std::string(suite->Attribute("name")));
      ++tests;
      failures += test->FirstChildElement("failure") != nullptr;
      errors += test->FirstChildElement("error") != nullptr;
      time_s += test->DoubleAttribute("time");
    }
    EXPECT_EQ(suite->IntAttribute("tests"), tests);
    EXPECT_EQ(suite->IntAttribute("failures"), failures);
    EXPECT_EQ(suite->IntAttribute("errors"), errors);
    EXPECT_NEAR(suite->DoubleAttribute("time"), time_s, 0.01);
    total_s += time_s;
  }
  EXPECT_GT(total_s, 0);
  EXPECT_NEAR(root->DoubleAttribute("time"), total_s, 0.02);

  const auto* near = root->LastChildElement();
  EXPECT_STREQ(near->FirstChildElement()->Attribute("name"), "frames min, seed 1");
  const auto* failed = near->FirstChildElement()->NextSiblingElement();
  EXPECT_STREQ(failed->Attribute("name"), "frames min max, seed 1");
  EXPECT_NE(std::string(failed->FirstChildElement("failure")->Attribute("message"))
                .find("frames is 4, must be at least 5 and at most 9"),
            std::string::npos);
  EXPECT_NE(std::string(failed->FirstChildElement("failure")->GetText())
                .find("\nreport.html#near/seed-1"),
            std::string::npos);
  EXPECT_NE(failed->NextSiblingElement()->FirstChildElement("skipped"), nullptr);
  EXPECT_EQ(root->IntAttribute("skipped"), 2);
  // Each criterion of a run has an equal share of its time.
  EXPECT_GT(failed->DoubleAttribute("time"), 0);
  EXPECT_EQ(failed->DoubleAttribute("time"), near->FirstChildElement()->DoubleAttribute("time"));
}

TEST(JUnit, EscapesWhatXmlCannotHold) {
  SuiteResult suite;
  ScenarioResult& scenario = suite.scenarios.emplace_back();
  scenario.name = "a<b & \"c\"";
  scenario.runs.emplace_back().error = "bad <byte> \xff, control \x1b[K, letter \xc3\xa9\nmore";
  const test::TemporaryFolder folder;
  write_junit(folder.path() / kJunitFile, suite, {}, {});
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.LoadFile((folder.path() / kJunitFile).c_str()), tinyxml2::XML_SUCCESS);
  const auto* element = document.RootElement()->FirstChildElement();
  EXPECT_STREQ(element->Attribute("name"), "a<b & \"c\"");
  const auto* error = element->FirstChildElement()->FirstChildElement("error");
  ASSERT_NE(error, nullptr);
  EXPECT_STREQ(error->Attribute("message"), R"(bad <byte> \xff, control \x1b[K, letter )"
                                            "\xc3\xa9");
  EXPECT_STREQ(error->GetText(), R"(bad <byte> \xff, control \x1b[K, letter )"
                                 "\xc3\xa9\nmore\nreport.html#a%3Cb%20&%20%22c%22/seed-0");
}

TEST(JUnit, HasATestCaseOfTheBaseline) {
  const test::TemporaryFolder folder;
  const auto kind_of = [&](Finding finding) -> std::string {
    write_junit(folder.path() / kJunitFile, suite_with({scenario_with("near", "rebel.f1", {0.5})}),
                {}, {.finding = finding, .line = "why"});
    tinyxml2::XMLDocument document;
    EXPECT_EQ(document.LoadFile((folder.path() / kJunitFile).c_str()), tinyxml2::XML_SUCCESS);
    EXPECT_EQ(document.RootElement()->IntAttribute("tests"), 2);
    const auto* baseline = document.RootElement()->LastChildElement();
    EXPECT_STREQ(baseline->Attribute("name"), "baseline");
    const auto* problem = baseline->FirstChildElement()->FirstChildElement();
    return problem ? problem->Name() : "";
  };
  EXPECT_EQ(kind_of(Finding::regressed), "failure");
  EXPECT_EQ(kind_of(Finding::not_judged), "error");
  EXPECT_EQ(kind_of(Finding::uncertain), "");
  EXPECT_EQ(kind_of(Finding::equal), "");
}

// ---- Failures of processes

class SuiteProcesses : public Suite {
 protected:
  /// A suite whose runs would take minutes, once two of them are under way.
  std::unique_ptr<test::Command> begin_endless() {
    for (const char* name : {"a", "b", "c"}) scenario(name, "", 100'000);
    auto command = std::make_unique<test::Command>(
        std::vector<std::string>{"suite", "scenarios", "--jobs", "2", "--seeds", "1"},
        test::CommandOptions{.folder = folder_.path()});
    while (command->is_running() && children_of(command->pid()).size() < 2) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return command;
  }
};

class SuiteInterrupted : public SuiteProcesses, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Signals, SuiteInterrupted, testing::Values(SIGINT, SIGTERM),
                         [](const auto& test) {
                           return test.param == SIGINT ? "SIGINT" : "SIGTERM";
                         });

TEST_P(SuiteInterrupted, EndsItsChildrenLeavesTheEarlierSuiteAndExitsWith130) {
  scenario("near");
  ASSERT_EQ(run({"--seeds", "1"}).exit_code, 0);
  const std::string before = read(out_ / kSuiteFile);

  const auto command = begin_endless();
  ASSERT_TRUE(command->is_running());
  const std::vector<pid_t> children = children_of(command->pid());
  command->send(GetParam());
  const CommandResult result = command->wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
  for (const pid_t child : children) EXPECT_NE(::kill(child, 0), 0) << "a child is left";
  EXPECT_EQ(entries(folder_.path() / "out"), std::set<std::string>{"suite"});
  EXPECT_EQ(read(out_ / kSuiteFile), before);
}

TEST_P(SuiteInterrupted, KeepsFinishedRunsAndGoesOnByTheSameCommand) {
  for (const char* name : {"a", "b", "c"}) scenario(name, "", name[0] == 'a' ? 4 : 100'000);
  const std::vector<std::string> arguments{"suite", "scenarios", "--jobs", "3", "--seeds", "1"};
  test::Command command(arguments, {.folder = folder_.path()});
  const fs::path kept = folder_.path() / "out" / "suite.unfinished" / "in";
  while (command.is_running() && !fs::exists(kept / "runs/a/seed-1/metrics.json")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the parent has seen its end
  command.send(GetParam());
  const CommandResult interrupted = command.wait();
  EXPECT_EQ(interrupted.exit_code, 130);
  EXPECT_NE(interrupted.err.find("1 of 3 runs are kept"), std::string::npos) << interrupted.err;

  const std::string first = read(kept / "runs/a/seed-1/run.json");
  const CommandResult other = run({"--jobs", "3", "--seeds", "1", "--set", "frames=5"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("settings differs ("), std::string::npos) << other.err;
  EXPECT_EQ(read(kept / "runs/a/seed-1/run.json"), first) << "a refusal loses nothing";
  for (const char* name : {"b", "c"}) scenario(name);
  EXPECT_NE(run({"--seeds", "1"}).err.find("scenarios/b.yaml differs"), std::string::npos);

  EXPECT_EQ(run({"--seeds", "1", "--anew"}).exit_code, 0);
  EXPECT_NE(read(out_ / "runs/a/seed-1/run.json"), first);
  EXPECT_EQ(entries(folder_.path() / "out"), std::set<std::string>{"suite"});
}

TEST_F(SuiteProcesses, PartsThatWereKilledAndWentOnMergeToTheWholeSuite) {
  for (const char* name : {"a", "b", "c", "d"})
    scenario(name, "criteria: [{metric: frames, min: 9}]\n");
  const std::vector<std::string> what{"--seeds", "2", "--jobs", "1", "--beside", "klt", "--quiet"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), what.begin(), what.end());
    return more;
  };
  ASSERT_EQ(run(with({"--out", "whole"})).exit_code, 1);
  for (const std::string part : {"1", "2", "3"}) {
    std::vector<std::string> arguments = with({"--shard", part + "/3", "--out", "part" + part});
    std::vector<std::string> all{"suite", "scenarios"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    test::Command command(all, {.folder = folder_.path()});
    const fs::path runs = folder_.path() / ("part" + part + ".unfinished") / "in/runs";
    const auto is_whole = [&] {
      if (!fs::exists(runs)) return false;
      for (const auto& entry : fs::recursive_directory_iterator(runs)) {
        if (entry.path().filename() == "metrics.json") return true;
      }
      return false;
    };
    while (command.is_running() && !is_whole()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    command.send(SIGKILL);
    command.wait();
    ASSERT_EQ(run(arguments).exit_code, 1) << "a criterion is not met";
  }
  const auto merge = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "merge");
    return test::run_lcs(arguments, {.folder = folder_.path()});
  };
  const CommandResult lacks = merge({"part1", "part3"});
  EXPECT_EQ(lacks.exit_code, 2);
  EXPECT_NE(lacks.err.find("there is no part 2 of 3"), std::string::npos) << lacks.err;
  EXPECT_NE(merge({"part1", "whole"}).err.find("whole is a whole suite"), std::string::npos);
  ASSERT_EQ(merge({"part2", "part1", "part3", "--out", "merged", "--quiet"}).exit_code, 1);

  const auto file = [&](const std::string& name) { return folder_.path() / name; };
  EXPECT_EQ(timeless(file("merged/suite.json")), timeless(file("whole/suite.json")));
  EXPECT_EQ(timeless(file("merged/beside/klt/suite.json")),
            timeless(file("whole/beside/klt/suite.json")));
  const auto names = [&](const std::string& folder) {
    std::set<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(file(folder))) {
      all.insert(entry.path().lexically_relative(file(folder)));
    }
    return all;
  };
  EXPECT_EQ(names("merged"), names("whole"));
  EXPECT_EQ(read(file("merged/runs/b/seed-2/truth.jsonl.gz")),
            read(file("whole/runs/b/seed-2/truth.jsonl.gz")));
}

TEST_F(SuiteProcesses, AChildThatCrashesIsAnErrorThatNamesTheSignal) {
  const auto command = begin_endless();
  ASSERT_TRUE(command->is_running());
  while (command->is_running()) {
    for (const pid_t child : children_of(command->pid())) {
      // Not a child of the leak sanitizer, whose command line equals its parent's.
      const bool is_run = test::command_line_of(child).find("--events") != std::string::npos;
      if (is_run) ::kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const CommandResult result = command->wait();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("crashed: ended by signal 9 (Killed)"), std::string::npos)
      << result.err;
  EXPECT_EQ(read_suite(out_ / kSuiteFile).scenarios[2].runs[0].outcome, Outcome::error);

  for (const char* name : {"a", "b", "c"}) scenario(name);
  EXPECT_EQ(run({"--seeds", "1"}).exit_code, 0) << "what the crashed left is in the way";
}

TEST(SuiteHelp, TeachesExamplesFilesAndExitCodes) {
  const test::TemporaryFolder folder;
  const CommandResult help = test::run_lcs({"suite", "--help"}, {.folder = folder.path()});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* part : {"Examples", "suite.json", "junit.xml", "Exit codes", "--jobs", "130"}) {
    EXPECT_NE(help.out.find(part), std::string::npos) << part << " in\n" << help.out;
  }
}

}  // namespace
}  // namespace lcs::suite
