#include "tools/suite/tables.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/tools/suites.h"
#include "tools/scoring/metrics.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

ScenarioResult scenario(const std::string& name, const std::vector<std::optional<double>>& f1s,
                        const std::vector<std::string>& groups = {"short"}) {
  ScenarioResult result = scenario_with(name, "rebel.f1", f1s);
  result.groups = groups;
  for (RunResult& run : result.runs) {
    run.metrics.emplace_back("dimension.mean", 20);
    run.metrics.emplace_back("dimension.five_frame_mean", 80);
  }
  return result;
}

ScenarioResult broken(const std::string& name) {
  ScenarioResult result;
  result.name = name;
  for (const std::uint64_t seed : {1, 2}) {
    RunResult& run = result.runs.emplace_back();
    run.seed = seed;
    run.error = "it fell over";
  }
  return result;
}

/// Number of columns on a terminal.
std::size_t columns(const std::string& line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

TEST(Summary, IsTakenOverTheSeedsThatHaveTheFigure) {
  const auto spread = over_seeds(scenario("near", {0.5, 0.9, std::nullopt}), "rebel.f1");
  ASSERT_TRUE(spread);
  EXPECT_DOUBLE_EQ(spread->mean, 0.7);
  EXPECT_DOUBLE_EQ(spread->half, 0.2);
  EXPECT_EQ(spread->count, 2);
  EXPECT_FALSE(over_seeds(scenario("near", {std::nullopt}), "rebel.f1"));
  EXPECT_FALSE(over_seeds(broken("near"), "rebel.f1"));
  EXPECT_DOUBLE_EQ(over_seeds(scenario("near", {0.5}), scoring::kSizeShare)->mean, 0.25);
}

TEST(Summary, OfAGroupWeighsItsScenariosAlikeHoweverManySeeds) {
  const SuiteResult suite =
      suite_with({scenario("a", {0.2, 0.4}, {"short", "night"}), scenario("b", {0.9}, {"short"}),
                  scenario("c", {std::nullopt}, {"night"})});
  EXPECT_DOUBLE_EQ(*over_group(suite, "short", "rebel.f1"), 0.6);
  EXPECT_DOUBLE_EQ(*over_group(suite, "night", "rebel.f1"), 0.3);
  EXPECT_FALSE(over_group(suite, "rain", "rebel.f1"));
  EXPECT_EQ(groups_of(suite), (std::vector<std::string>{"all", "short", "night"}));
}

TEST(Summary, AnOutcomeIsTheWorstOfItsRuns) {
  SuiteResult suite = suite_with({scenario("a", {0.2, 0.4})});
  EXPECT_EQ(outcome_of(suite), Outcome::passed);
  suite.scenarios[0].runs[1].outcome = Outcome::failed;
  EXPECT_EQ(outcome_of(suite), Outcome::failed);
  suite.scenarios.push_back(broken("b"));
  EXPECT_EQ(outcome_of(suite), Outcome::error);
}

TEST(SuiteTable, FitsATerminalOf120ColumnsAndCutsNoName) {
  const std::string long_name(130, 'n');
  for (const std::size_t length : {4u, 15u, 25u, 60u}) {
    const std::string name(length, 'x');
    for (const auto& f1s : {std::vector<std::optional<double>>{0.5}, {0.5, 0.6, 0.1}}) {
      const std::string text = suite_table(
          suite_with({scenario(name, f1s), scenario("other", f1s), broken("broken")}), false);
      EXPECT_NE(text.find(name), std::string::npos) << text;
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) EXPECT_LE(columns(line), 120u) << line;
    }
  }
  EXPECT_NE(suite_table(suite_with({scenario(long_name, {0.5})}), false).find(long_name),
            std::string::npos);
}

TEST(SuiteTable, ShowsMeansWithHalfTheirSpreadGroupsAndADashForWhatIsUndefined) {
  const std::string several = suite_table(suite_with({scenario("near", {0.5, 0.6})}), false);
  EXPECT_NE(several.find("0.55±.05"), std::string::npos) << several;
  EXPECT_NE(several.find("= short (1)"), std::string::npos) << several;
  const std::string single = suite_table(suite_with({scenario("near", {0.5})}), false);
  EXPECT_NE(single.find("0.50"), std::string::npos) << single;
  EXPECT_EQ(single.find("±"), std::string::npos) << single;
  EXPECT_NE(single.find(" - "), std::string::npos) << single;
}

TEST(SuiteTable, PrecisionRecallAndF1OfAGroupAreOverTheScenariosInWhichSomethingMoves) {
  const std::string text =
      suite_table(suite_with({scenario("near", {0.5}), scenario("static", {std::nullopt})}), false);
  EXPECT_NE(text.find("= short (2, 1 with F1)"), std::string::npos) << text;
  EXPECT_NE(text.find("0.50"), std::string::npos) << text;
}

TEST(SuiteTable, OfWorldsHasTheIntervalOfTheMeanOfEachGroup) {
  SuiteResult suite =
      suite_with({scenario("a", {0.5}, {"world", "room"}), scenario("b", {0.6}, {"world", "room"}),
                  scenario("c", {0.7}, {"world", "yard"})});
  EXPECT_FALSE(is_of_worlds(suite));
  EXPECT_EQ(suite_table(suite, false).find("±"), std::string::npos);
  for (ScenarioResult& one : suite.scenarios) one.drawn = Drawn{};
  EXPECT_TRUE(is_of_worlds(suite));
  const std::string text = suite_table(suite, false);
  for (const char* row : {"= world (3)", "0.60±.25", "= room (2)", "0.55±.64", "= yard (1)",
                          "the 95 % interval of its mean over worlds"}) {
    EXPECT_NE(text.find(row), std::string::npos) << row << " in\n" << text;
  }
  EXPECT_FALSE(is_of_worlds(suite_with({})));
}

TEST(SuiteTable, MarksFailuresAndErrorsAndPutsTheWorstFirstOnRequest) {
  SuiteResult suite = suite_with({scenario("fine", {0.9}), scenario("poor", {0.1}),
                                  scenario("static", {std::nullopt}), broken("broken")});
  suite.scenarios[1].runs[0].outcome = Outcome::failed;
  const auto order = [&](bool worst_first) {
    const std::string text = suite_table(suite, worst_first);
    std::vector<std::pair<std::size_t, std::string>> places;
    for (const char* row : {"  fine", "F poor", "  static", "E broken"}) {
      EXPECT_NE(text.find(row), std::string::npos) << row << " in\n" << text;
      places.emplace_back(text.find(row), row);
    }
    std::sort(places.begin(), places.end());
    std::vector<std::string> rows;
    for (const auto& [place, row] : places) rows.push_back(row);
    return rows;
  };
  EXPECT_EQ(order(false), (std::vector<std::string>{"  fine", "F poor", "  static", "E broken"}));
  EXPECT_EQ(order(true), (std::vector<std::string>{"E broken", "F poor", "  fine", "  static"}));
}

/// A scenario with one criterion over its seeds.
ScenarioResult asked_over(const std::string& over, std::vector<std::optional<double>> values,
                          std::optional<double> min, std::optional<double> max = {}) {
  ScenarioResult scenario = scenario_with("near", "rebel.f1", values);
  for (RunResult& run : scenario.runs) {
    run.criteria = {{.metric = "rebel.f1",
                     .min = min,
                     .max = max,
                     .value = {},
                     .over = over,
                     .place = "near.yaml:3"}};
  }
  judge_over_seeds(scenario);
  return scenario;
}

TEST(CriteriaOverSeeds, AreOfTheMeanOrOfItsWholeInterval) {
  const auto outcome = [](const ScenarioResult& scenario) { return outcome_of(scenario); };
  // Mean 0.8, 95 % interval 0.8 +- 4.303 * 0.02 / sqrt(3): from 0.7503 to 0.8497.
  const std::vector<std::optional<double>> values{0.78, 0.80, 0.82};
  EXPECT_EQ(outcome(asked_over("mean", values, 0.79)), Outcome::passed) << "a seed is below";
  EXPECT_EQ(outcome(asked_over("mean", values, 0.81)), Outcome::failed);
  EXPECT_EQ(outcome(asked_over("interval", values, 0.75, 0.85)), Outcome::passed);
  EXPECT_EQ(outcome(asked_over("interval", values, 0.76)), Outcome::failed);
  EXPECT_EQ(outcome(asked_over("interval", values, {}, 0.84)), Outcome::failed);
  EXPECT_EQ(outcome(asked_over("interval", {0.8}, 0.1)), Outcome::failed) << "noise unknown";
  EXPECT_EQ(outcome(asked_over("mean", {0.8, std::nullopt}, 0.1)), Outcome::failed);
  EXPECT_EQ(
      problems(suite_with({asked_over("interval", values, 0.76)})),
      (std::vector<std::string>{"failed: near: near.yaml:3: rebel.f1 is from 0.7503 to 0.8497, "
                                "the 95 % interval of the mean over 3 seeds, must be at least "
                                "0.76"}));
}

TEST(Problems, TellAnErrorOfSeveralSeedsOnce) {
  SuiteResult suite = suite_with({scenario("near", {0.5}), broken("broken")});
  suite.scenarios[0].runs[0].criteria = {
      {"rebel.f1", 0.6, {}, 0.5, true, false, "seed", "", "rebel.f1 is 0.5, must be at least 0.6"},
      {"rebel.f1", 0.4, {}, 0.5, true, true, "seed", "", ""}};
  EXPECT_EQ(problems(suite),
            (std::vector<std::string>{"failed: near seed 1: rebel.f1 is 0.5, must be at least 0.6",
                                      "error: broken seed 1, 2: it fell over"}));
  EXPECT_EQ(run_counts(suite), "3 runs of 2 scenarios: 1 passed, 0 failed, 2 with an error");
}

TEST(Warnings, AreToldOnceAScenarioWithTheSeedsAndNotWhereNothingHappened) {
  SuiteResult suite = suite_with({scenario("quiet", {0.5}), scenario("near", {0.5, 0.6, 0.7})});
  std::vector<RunResult>& near = suite.scenarios[1].runs;
  near[0].warnings = {{"rover_tipped", 1, "the rover tips over at 2 s: make it slower"}};
  near[2].warnings = {{"rover_tipped", 3, "the rover tips over at 1 s: make it slower"},
                      {"few_corners", 40, "few corners"}};
  EXPECT_EQ(warnings(suite),
            (std::vector<std::string>{"near seed 1, 3: the rover tips over at 2 s: make it slower "
                                      "(warnings.rover_tipped: 1)",
                                      "near seed 3: few corners (warnings.few_corners: 40)"}));
}

}  // namespace
}  // namespace lcs::suite
