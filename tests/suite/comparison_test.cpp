#include "tools/suite/comparison.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include "tests/tools/suites.h"
#include "tests/tools/temporary_folder.h"
#include "tools/suite/verdict.h"

namespace lcs::suite {
namespace {

using Values = std::vector<std::optional<double>>;

Comparison compare_all(const SuiteResult& before, const SuiteResult& after) {
  return compare(before, after, [](std::string_view) { return true; });
}

/// Compares suites with one scenario and one figure.
Comparison compare_values(const Values& before, const Values& after,
                          const std::string& metric = "rebel.f1") {
  return compare_all(suite_with({scenario_with("near", metric, before)}),
                     suite_with({scenario_with("near", metric, after)}));
}

bool names(const Comparison& comparison, const std::string& what) {
  return std::find(comparison.incomparable.begin(), comparison.incomparable.end(), what) !=
         comparison.incomparable.end();
}

// ---- The statistics

/// Student's t, from printed tables.
TEST(Interval, IsTheOneOfTheTables) {
  // Two-sided 95 %.
  const std::pair<int, double> table[] = {{1, 12.706}, {2, 4.303},  {4, 2.776},  {9, 2.262},
                                          {10, 2.228}, {15, 2.131}, {30, 2.042}, {1000, 1.962}};
  for (const auto& [degrees, t] : table) {
    std::vector<double> values(static_cast<std::size_t>(degrees) + 1, 0.0);
    values.back() = 1;
    const Interval interval = interval_of(values);
    ASSERT_EQ(interval.degrees_of_freedom, degrees);
    EXPECT_NEAR(*interval.half / interval.error, t, 0.0006) << degrees;
  }
  // Both tails.
  const auto beyond = [](double t, int degrees) {
    return chance_beyond({.mean = t, .half = 1, .error = 1, .degrees_of_freedom = degrees}, 0);
  };
  EXPECT_NEAR(beyond(3.182, 3), 0.05, 2e-5);
  EXPECT_NEAR(beyond(9.925, 2), 0.01, 1e-5);
  EXPECT_NEAR(beyond(4.587, 10), 0.001, 1e-6);
  EXPECT_EQ(beyond(0, 5), 1);
}

TEST(Interval, IsTheOneOfTheTextbook) {
  const Interval interval = interval_of({1, 2, 3});  // deviation 1
  EXPECT_DOUBLE_EQ(interval.mean, 2);
  ASSERT_TRUE(interval.half);
  EXPECT_NEAR(*interval.half, 4.30265 / std::sqrt(3), 1e-5);
  EXPECT_EQ(interval_of({1}).half, std::nullopt);
  EXPECT_EQ(*interval_of({0.5, 0.5}).half, 0);
}

TEST(Interval, OfStrataHasTheNoiseWithinThemOnly) {
  // Two strata with deviations 1 and 2, of two and three values.
  const Interval interval = interval_of_strata({{0, std::sqrt(2)}, {8, 10, 12}});
  EXPECT_DOUBLE_EQ(interval.mean, (std::sqrt(2) / 2 + 10) / 2);
  EXPECT_NEAR(interval.error, std::sqrt(1.0 / 2 + 4.0 / 3) / 2, 1e-12);
  // Welch and Satterthwaite: (1/2 + 4/3)^2 / ((1/2)^2 / 1 + (4/3)^2 / 2) = 2.95, rounded down.
  EXPECT_EQ(interval.degrees_of_freedom, 2);
  // A stratum with one value has no noise of its own: the spread of the means takes its place.
  EXPECT_NEAR(*interval_of_strata({{1, 3}, {4}}).half, 12.7062, 1e-4);
  EXPECT_EQ(interval_of_strata({{1}}).half, std::nullopt);
}

TEST(RealAmong, IsHolmsRule) {
  // Of four: .012 <= .05 / 4, .016 <= .05 / 3, .03 > .05 / 2 ends it although .04 <= .05.
  EXPECT_EQ(real_among({0.03, 0.012, 0.04, 0.016}), (std::vector<bool>{false, true, false, true}));
  EXPECT_TRUE(real_among({}).empty());
}

/// Suites of `count` worlds or scenarios with figures of independent noise, in part 10 times as
/// large as usual. \param seeds of each.
SuiteResult noise(int count, int seeds, bool of_worlds, std::mt19937& random) {
  constexpr const char* kFigures[] = {"rebel.f1", "rebel.recall", "square.recall_50",
                                      "rebel.object_recall", "rebel.f1_distinct"};
  std::normal_distribution<double> usual(0, 0.03);
  std::vector<ScenarioResult> scenarios;
  for (int i = 0; i < count; ++i) {
    ScenarioResult one = scenario_with("world_" + std::to_string(i), "frames",
                                       Values(static_cast<std::size_t>(seeds), 60));
    one.groups = {"short", i % 4 == 0 ? "night" : "day"};
    if (of_worlds) one.drawn = Drawn{one.groups[1], 0, {}};
    for (RunResult& run : one.runs) {
      for (const char* figure : kFigures) {
        const double size = random() % 20 == 0 ? 10 : 1;
        run.metrics.emplace_back(figure, 0.5 + size * usual(random));
      }
    }
    scenarios.push_back(std::move(one));
  }
  return suite_with(scenarios);
}

TEST(Compare, SuitesThatDifferByNoiseAloneSeldomRegress) {
  // 200 comparisons: the expected number of false alarms is at most 5, for one side of 5 %. Chance
  // exceeds 12 once in 200.
  for (const auto& [count, seeds, of_worlds] :
       {std::tuple(60, 1, true), std::tuple(40, 3, false), std::tuple(8, 1, false)}) {
    std::mt19937 random(count);
    int alarms = 0;
    for (int i = 0; i < 200; ++i) {
      const SuiteResult before = noise(count, seeds, of_worlds, random);
      alarms += compare_all(before, noise(count, seeds, of_worlds, random)).has_regressed();
    }
    EXPECT_LE(alarms, 12) << count << " with " << seeds;
  }
}

TEST(Compare, ALossOverAllWorldsIsFoundThoughEachWorldIsNoisy) {
  std::mt19937 random(1);
  const SuiteResult before = noise(60, 1, true, random);
  SuiteResult after = noise(60, 1, true, random);
  for (ScenarioResult& world : after.scenarios) {
    for (auto& [name, figure] : world.runs[0].metrics) {
      if (name == "rebel.f1") *figure -= 0.15;  // five standard deviations of the mean's noise
    }
  }
  const Comparison comparison = compare_all(before, after);
  EXPECT_TRUE(comparison.has_regressed());
  EXPECT_TRUE(comparison.with(Change::regressed).empty()) << "a world of one seed has no verdict";
  EXPECT_GT(comparison.with(Change::unknown).size(), 30U);
}

// ---- The verdicts

TEST(Compare, TheSameSuiteTwiceHasNoChange) {
  const Comparison comparison = compare_values({0.5, 0.7, 0.6}, {0.5, 0.7, 0.6});
  ASSERT_EQ(comparison.differences.size(), 1u);
  EXPECT_EQ(comparison.differences[0].verdict, Change::none);
  EXPECT_EQ(comparison.judged, 1);
  EXPECT_TRUE(comparison.incomparable.empty());
}

TEST(Compare, AClearGainIsFoundThoughSeedsDifferByMore) {
  // 0.1 more in each seed, while the seeds differ by 0.4: significant in pairs, not in the means.
  const Comparison comparison = compare_values({0.3, 0.7, 0.5}, {0.40, 0.81, 0.60});
  const Difference& difference = comparison.differences.at(0);
  EXPECT_EQ(difference.verdict, Change::improved);
  EXPECT_NEAR(difference.before, 0.5, 1e-12);
  EXPECT_NEAR(difference.after, 0.60333, 1e-4);
  EXPECT_EQ(difference.pairs, 3);
}

TEST(Compare, AClearLossIsFound) {
  EXPECT_EQ(compare_values({0.8, 0.81, 0.79}, {0.6, 0.62, 0.6}).with(Change::regressed).size(), 1U);
}

TEST(Compare, LessIsBetterWhereLowerIs) {
  const char* metric = "rebel.latency_frames_median";
  EXPECT_EQ(compare_values({2, 2, 2}, {4, 4, 4}, metric).with(Change::regressed).size(), 1U);
  EXPECT_EQ(compare_values({4, 4, 4}, {2, 2, 2}, metric).with(Change::improved).size(), 1U);
}

TEST(Compare, ADifferenceWithinTheNoiseOfSeedsIsNone) {
  // +0.05 on average, from -0.05, 0.05 and 0.15.
  EXPECT_EQ(compare_values({0.5, 0.5, 0.5}, {0.45, 0.55, 0.65}).differences.at(0).verdict,
            Change::none);
}

TEST(Compare, ACertainButTinyDifferenceIsNone) {
  EXPECT_EQ(compare_values({0.5, 0.6, 0.7}, {0.501, 0.601, 0.701}).differences.at(0).verdict,
            Change::none);
  // The whole interval must lie beyond the margin, not only its middle: 0.012 +- 0.005.
  EXPECT_EQ(compare_values({0.5, 0.5, 0.5}, {0.510, 0.512, 0.514}).differences.at(0).verdict,
            Change::none);
}

TEST(Compare, WithOneSeedTheChangeOfAScenarioIsUnknown) {
  const Comparison comparison = compare_values({0.5}, {0.4});
  EXPECT_EQ(comparison.differences.at(0).verdict, Change::unknown);
  EXPECT_EQ(comparison.differences.at(0).change.half, std::nullopt);
  EXPECT_FALSE(comparison.has_regressed());
  EXPECT_EQ(comparison.groups.at(0).verdict, Change::unknown);
  EXPECT_EQ(comparison.judged_means, 0);
  EXPECT_NE(text_of(comparison, false).find("noise unknown"), std::string::npos);
  EXPECT_EQ(compare_values({0.5}, {0.495}).with(Change::unknown).size(), 0U);
}

TEST(Compare, TimesAreNeverComparedAndNeutralFiguresNeverJudged) {
  EXPECT_TRUE(compare_values({1, 1}, {9, 9}, "time.filter_ms_median").differences.empty());
  const Comparison comparison = compare_values({100, 100}, {200, 200}, "truth.rebel_corners");
  EXPECT_EQ(comparison.differences.at(0).verdict, Change::moved);
  EXPECT_EQ(comparison.judged, 0);
}

TEST(Compare, TheSizeBesideAStoreIsJudgedAsAnyOtherFigure) {
  const auto with_size = [](double size) {
    ScenarioResult scenario = scenario_with("near", "dimension.mean", {size, size});
    for (RunResult& run : scenario.runs) run.metrics.push_back({"dimension.five_frame_mean", 100});
    return suite_with({scenario});
  };
  const Comparison comparison = compare(with_size(20), with_size(30), [](std::string_view name) {
    return name == scoring::kSizeShare;
  });
  ASSERT_EQ(comparison.differences.size(), 1u);
  EXPECT_EQ(comparison.differences[0].verdict, Change::regressed);
  EXPECT_DOUBLE_EQ(comparison.differences[0].after, 0.3);
}

// ---- Scenarios and groups

TEST(Compare, AScenarioIsAsItsWorstFigure) {
  const auto with = [](double f1, double recall) {
    ScenarioResult scenario = scenario_with("near", "rebel.f1", {f1, f1});
    for (RunResult& run : scenario.runs) run.metrics.push_back({"rebel.recall", recall});
    return suite_with({scenario});
  };
  EXPECT_EQ(compare_all(with(0.5, 0.5), with(0.6, 0.5)).of_scenario("near"), Change::improved);
  EXPECT_EQ(compare_all(with(0.5, 0.5), with(0.6, 0.4)).of_scenario("near"), Change::regressed);
  EXPECT_EQ(compare_all(with(0.5, 0.5), with(0.5, 0.5)).of_scenario("near"), Change::none);
  EXPECT_EQ(compare_all(with(0.5, 0.5), with(0.5, 0.5)).of_scenario("far"), std::nullopt);
}

TEST(Compare, AGroupChangesByTheNoiseOfItsSeedsAsItsScenariosAreNoSample) {
  // Scenarios differ in their change by far more than seeds do.
  const auto with = [](const Values& near, const Values& far) {
    return suite_with(
        {scenario_with("near", "rebel.f1", near), scenario_with("far", "rebel.f1", far)});
  };
  const Comparison comparison =
      compare_all(with({0.5, 0.5}, {0.5, 0.5}), with({0.80, 0.82}, {0.52, 0.50}));
  ASSERT_EQ(comparison.groups.size(), 1u);
  const Difference& group = comparison.groups[0];
  EXPECT_EQ(group.scenario, "short");
  EXPECT_NEAR(group.change.mean, 0.16, 1e-12);
  // Each scenario's mean has a standard error of 0.01; two degrees of freedom.
  EXPECT_NEAR(group.change.half.value(), 4.3027 * std::sqrt(2) * 0.01 / 2, 1e-5);
  EXPECT_EQ(group.verdict, Change::improved);
}

TEST(Compare, AGroupOfWorldsChangesWorldByWorld) {
  const auto with = [](double one, double two) {
    SuiteResult suite = suite_with(
        {scenario_with("room_1", "rebel.f1", {one}), scenario_with("room_2", "rebel.f1", {two})});
    for (ScenarioResult& world : suite.scenarios) world.drawn = Drawn{"room", 0, {}};
    return suite;
  };
  const Comparison comparison = compare_all(with(0.5, 0.5), with(0.8, 0.52));
  ASSERT_EQ(comparison.groups.size(), 1u);
  EXPECT_EQ(comparison.groups[0].pairs, 2);
  EXPECT_NEAR(comparison.groups[0].change.half.value(), 12.7062 * 0.14, 1e-3);
  EXPECT_EQ(comparison.groups[0].verdict, Change::none);
}

// ---- Incomparable suites

TEST(Compare, AScenarioOfOneSideIsNamed) {
  const ScenarioResult both = scenario_with("both", "rebel.f1", {0.5, 0.5});
  const Comparison comparison =
      compare_all(suite_with({both, scenario_with("old", "rebel.f1", {0.5})}),
                  suite_with({scenario_with("new", "rebel.f1", {0.5}), both}));
  EXPECT_EQ(comparison.scenarios, std::vector<std::string>{"both"});
  EXPECT_EQ(comparison.differences.size(), 1u);
  EXPECT_TRUE(names(comparison, "old: only before"));
  EXPECT_TRUE(names(comparison, "new: only after"));
}

TEST(Compare, AFigureUndefinedOnOneSideIsNamedAndLeftOutOfThePairs) {
  const Comparison comparison = compare_values({0.5, std::nullopt, 0.5}, {std::nullopt, 0.5, 0.5});
  EXPECT_TRUE(names(comparison, "near: rebel.f1 undefined after, seed 1"));
  EXPECT_TRUE(names(comparison, "near: rebel.f1 undefined before, seed 2"));
  EXPECT_EQ(comparison.differences.at(0).pairs, 1);
}

TEST(Compare, AFigureUndefinedOnBothSidesIsNoNews) {
  const Comparison comparison = compare_values({std::nullopt}, {std::nullopt});
  EXPECT_TRUE(comparison.differences.empty());
  EXPECT_TRUE(comparison.incomparable.empty());
}

TEST(Compare, OnlySeedsOfBothSidesArePaired) {
  const Comparison comparison = compare_values({0.5, 0.6, 0.7}, {0.5, 0.6});
  EXPECT_EQ(comparison.differences.at(0).pairs, 2);
  EXPECT_EQ(comparison.differences.at(0).before, 0.55) << "seed 3 is left out of the mean too";
  EXPECT_TRUE(names(comparison, "near: seed 3 only before"));
}

TEST(Compare, ARunThatEndsWithAnErrorNowIsNamedAndIsARegression) {
  SuiteResult before = suite_with({scenario_with("near", "rebel.f1", {0.5, 0.5})});
  SuiteResult after = before;
  after.scenarios[0].runs[1] = {};
  after.scenarios[0].runs[1].seed = 2;
  const Comparison lost = compare_all(before, after);
  EXPECT_TRUE(names(lost, "near: seed 2 ended with an error after"));
  EXPECT_EQ(lost.lost, std::set<std::string>{"near"});
  EXPECT_EQ(lost.of_scenario("near"), Change::regressed);
  EXPECT_TRUE(lost.has_regressed());
  const Comparison gained = compare_all(after, before);
  EXPECT_TRUE(names(gained, "near: seed 2 ended with an error before"));
  EXPECT_FALSE(gained.has_regressed());
}

TEST(Compare, ALostShareOfF1IsNotBetterWhereF1Falls) {
  const auto with = [](double f1, double lost) {
    ScenarioResult scenario = scenario_with("near", "rebel.f1", {f1, f1});
    for (RunResult& run : scenario.runs) run.metrics.emplace_back("rebel.f1_lost_outline", lost);
    return suite_with({scenario});
  };
  const auto verdict = [](const SuiteResult& before, const SuiteResult& after) {
    const Comparison comparison = compare_all(before, after);
    EXPECT_EQ(comparison.differences.at(1).metric, "rebel.f1_lost_outline");
    EXPECT_EQ(comparison.groups.at(1).verdict, comparison.differences[1].verdict);
    return comparison.differences[1].verdict;
  };
  EXPECT_EQ(verdict(with(0.8, 0.1), with(0.3, 0.05)), Change::moved);
  EXPECT_EQ(verdict(with(0.8, 0.1), with(0.85, 0.05)), Change::improved);
  EXPECT_EQ(verdict(with(0.8, 0.05), with(0.75, 0.1)), Change::regressed);
}

// ---- The finding

/// Suites of worlds with one value of a figure each.
Comparison compare_worlds(const Values& before, const Values& after,
                          const std::string& metric = "rebel.f1") {
  const auto worlds = [&](const Values& values) {
    SuiteResult suite = suite_with({});
    for (std::size_t i = 0; i < values.size(); ++i) {
      suite.scenarios.push_back(scenario_with("room_" + std::to_string(i), metric, {values[i]}));
      suite.scenarios.back().drawn = Drawn{"room", 0, {}};
    }
    return suite;
  };
  return compare_all(worlds(before), worlds(after));
}

std::string told(const Comparison& comparison, int failed_criteria = 0) {
  return text_of(comparison.finding(failed_criteria), comparison, failed_criteria);
}

TEST(Finding, AnUnchangedSuiteIsEqual) {
  const Comparison same = compare_values({0.5, 0.7, 0.6}, {0.5, 0.7, 0.6});
  EXPECT_EQ(same.finding(0), Finding::equal);
  EXPECT_EQ(told(same), "equal: no loss above 0.000 of rebel.f1");
  EXPECT_EQ(compare_values({0.5}, {0.5}).finding(0), Finding::equal) << "one seed, the same bits";
}

TEST(Finding, ALossBelowTwiceTheLeastChangeThatMattersIsEqual) {
  const Comparison within = compare_values({0.5, 0.6, 0.7}, {0.489, 0.590, 0.691});
  EXPECT_EQ(within.finding(0), Finding::equal);
  EXPECT_EQ(told(within), "equal: no loss above 0.012 of rebel.f1");
}

TEST(Finding, ALossThatIsNotExcludedIsToldWithTheWorldsThatWouldShowIt) {
  // -.01 +- .1: neither a regression nor equal. t(3) = 3.18 and a deviation of 0.0632 give 0.1007.
  const Comparison wide = compare_worlds({0.5, 0.5, 0.5, 0.5}, {0.4168, 0.4353, 0.5448, 0.5631});
  EXPECT_EQ(wide.finding(0), Finding::uncertain);
  const auto [mean, half, error, degrees] = wide.groups.at(0).change;
  EXPECT_EQ(told(wide),
            fmt::format("no regression found, but a loss of up to {:.3f} of rebel.f1 is "
                        "not excluded (some {:.0f} worlds would tell 0.02 of rebel.f1 "
                        "apart)",
                        *half - mean, 4 * std::pow(1.96 * error / 0.02, 2)));
}

/// Each main figure loses where it gets worse, whichever direction that is.
TEST(Finding, RestsOnEachMainFigureAndOnNoOther) {
  EXPECT_EQ(compare_values({0.8, 0.81, 0.79}, {0.6, 0.62, 0.6}).finding(0), Finding::regressed);
  for (const char* worse_if_more :
       {"rebel.false_corners_per_frame", "rebel.false_objects_per_100_frames"}) {
    EXPECT_EQ(compare_values({1, 1, 1}, {9, 9.1, 9}, worse_if_more).finding(0), Finding::regressed);
    EXPECT_EQ(compare_values({9, 9.1, 9}, {1, 1, 1}, worse_if_more).finding(0), Finding::equal);
  }
  const auto with = [](double memory) {
    ScenarioResult scenario = scenario_with("near", "rebel.f1", {0.5, 0.5});
    for (RunResult& run : scenario.runs) run.metrics.emplace_back("dimension.mean", memory);
    return suite_with({scenario});
  };
  const Comparison larger = compare_all(with(100), with(200));
  EXPECT_EQ(larger.finding(0), Finding::uncertain);
  EXPECT_EQ(told(larger), "no regression found, but 1 other mean regressed, 1 scenario regressed");
}

TEST(Finding, OfFiguresThatAreAskedForRestsOnThese) {
  const auto memory = [](double mean) {
    return suite_with({scenario_with("near", "dimension.mean", {mean, mean})});
  };
  EXPECT_EQ(compare(memory(100), memory(200),
                    [](std::string_view key) { return key.starts_with("dimension"); })
                .finding(0),
            Finding::regressed);
}

/// A suite that shrinks must not become green.
TEST(Finding, MissingScenariosSeedsAndFramesAreNotJudged) {
  const ScenarioResult near = scenario_with("near", "rebel.f1", {0.5, 0.5}),
                       far = scenario_with("far", "rebel.f1", {0.5, 0.5});
  Comparison fewer = compare_all(suite_with({near, far}), suite_with({near}));
  EXPECT_EQ(fewer.finding(0), Finding::not_judged);
  EXPECT_EQ(told(fewer),
            "not judged: missing or other frames than before: far; --allow-missing judges the "
            "others");
  fewer.missing.clear();
  EXPECT_EQ(fewer.finding(0), Finding::equal);
  EXPECT_EQ(compare_all(suite_with({near}), suite_with({near, far})).finding(0), Finding::equal);
  EXPECT_EQ(compare_values({0.5, 0.5, 0.5}, {0.5, 0.5}).finding(0), Finding::not_judged);
  const auto with_frames = [&](double frames) {
    ScenarioResult scenario = near;
    for (RunResult& run : scenario.runs) run.metrics.emplace_back("frames", frames);
    return suite_with({scenario});
  };
  EXPECT_EQ(compare_all(with_frames(50), with_frames(50)).finding(0), Finding::equal);
  EXPECT_EQ(compare_all(with_frames(50), with_frames(8)).finding(0), Finding::not_judged);
}

TEST(Finding, ARegressionIsToldThoughRunsAreMissing) {
  const auto with = [](double f1) { return scenario_with("near", "rebel.f1", {f1, f1}); };
  EXPECT_EQ(compare_all(suite_with({with(0.8), scenario_with("far", "rebel.f1", {0.5})}),
                        suite_with({with(0.5)}))
                .finding(0),
            Finding::regressed);
}

TEST(Finding, SuitesWithoutAMainFigureInBothAreNotJudged) {
  const Comparison none = compare_values({0.5, 0.5}, {std::nullopt, std::nullopt});
  EXPECT_EQ(none.finding(0), Finding::not_judged);
  EXPECT_EQ(told(none), "not judged: no main figure is in both suites");
}

TEST(Finding, AFailedCriterionOrAFigureThatIsNoLongerDefinedIsNotEqual) {
  const Comparison same = compare_values({0.5, 0.5}, {0.5, 0.5});
  EXPECT_EQ(same.finding(1), Finding::uncertain);
  EXPECT_EQ(told(same, 1), "no regression found, but failed criteria and runs: 1");
  const Comparison lost = compare_values({0.5, 0.5, 0.5}, {0.5, 0.5, std::nullopt});
  EXPECT_EQ(told(lost),
            "no regression found, but 1 main figure of a scenario is no longer defined");
}

// ---- Text output

TEST(ComparisonText, TellsWhatRegressedAndImprovedWithTheInterval) {
  const SuiteResult before = suite_with({scenario_with("near", "rebel.f1", {0.5, 0.5}),
                                         scenario_with("far", "rebel.f1", {0.5, 0.5}),
                                         scenario_with("same", "rebel.f1", {0.5, 0.5})});
  const SuiteResult after = suite_with({scenario_with("near", "rebel.f1", {0.75, 0.75}),
                                        scenario_with("far", "rebel.f1", {0.25, 0.25}),
                                        scenario_with("same", "rebel.f1", {0.5, 0.5})});
  const std::string text = text_of(compare_all(before, after), false);
  EXPECT_EQ(text,
            "means over so many scenarios, with the 95 % interval of each change:\n"
            "mean over  figure    before  after  change  verdict\n"
            "short (3)  rebel.f1   0.500  0.500  +0.000  none\n"
            "\n"
            "scenario  figure    before  after  change  verdict\n"
            "far       rebel.f1   0.500  0.250  -0.250  regressed\n"
            "near      rebel.f1   0.500  0.750  +0.250  improved\n"
            "each figure of a single scenario is judged by its own interval: of 3, chance alone "
            "changes up to 1\n");
  const std::string all = text_of(compare_all(before, after), true);
  EXPECT_NE(all.find("same      rebel.f1   0.500  0.500  +0.000  none\n"), std::string::npos)
      << all;
}

// ---- Looks at a suite while it runs

TEST(Looks, SpendTheProbabilityOfAFalseAlarmAndEndWithAllRuns) {
  for (const std::size_t runs : {1u, 9u, 10u, 29u, 60u, 129u, 1000u}) {
    const std::vector<Look> looks = looks_of(runs);
    EXPECT_EQ(looks.back().runs, runs);
    EXPECT_LE(looks.size(), 6u);
    double spent = 0;
    std::size_t before = 0;
    for (const Look& look : looks) {
      if (looks.size() > 1) {
        EXPECT_GE(look.runs - before, 5u) << runs;
      }
      before = look.runs;
      spent += look.level;
    }
    EXPECT_NEAR(spent, 0.05, 1e-12) << runs;
    EXPECT_TRUE(std::ranges::is_sorted(looks, {}, &Look::level)) << "early looks spend less";
  }
}

TEST(Looks, TakeTheFamiliesInTurnTheWorstFirstAndTheFirstSeedOfAllFirst) {
  SuiteResult baseline = suite_with({});
  for (const auto& [name, family, f1] :
       {std::tuple("r1", "room", 0.8), std::tuple("r2", "room", 0.8),
        std::tuple("s1", "street", 0.4)}) {
    ScenarioResult world = scenario_with(name, "rebel.f1", {f1, f1});
    world.drawn = Drawn{family, 0, {}};
    baseline.scenarios.push_back(world);
  }
  const std::vector<RunName> order = order_of(planned(baseline), baseline);
  EXPECT_EQ(order, (std::vector<RunName>{
                       {"s1", 1}, {"r1", 1}, {"r2", 1}, {"s1", 2}, {"r1", 2}, {"r2", 2}}));
}

TEST(Looks, AGrossLossEndsTheSuiteAtTheFirst) {
  std::mt19937 random(1);
  const SuiteResult before = noise(60, 1, true, random);
  SuiteResult after = before;
  for (ScenarioResult& world : after.scenarios) {
    world.runs[0].metrics[1].second = *world.runs[0].metrics[1].second - 0.3;  // rebel.f1
  }
  const std::vector<RunName> order = order_of(planned(before), before);
  const std::vector<Look> looks = looks_of(order.size());
  const SuiteResult made = at_look(after, order, looks[0]);
  const Comparison comparison = compare_all(before, made);
  EXPECT_EQ(made.scenarios.size(), 10u);
  EXPECT_TRUE(comparison.missing.empty()) << "only the runs of a stopped suite are compared";
  EXPECT_TRUE(comparison.has_regressed());
  EXPECT_DOUBLE_EQ(comparison.level, looks[0].level);
  EXPECT_TRUE(is_certain(comparison, looks, 0));
}

TEST(Looks, NoRegressionIsConcludedFromLessThanHalfOfTheRuns) {
  std::mt19937 random(1);
  const SuiteResult before = noise(60, 1, true, random);
  const std::vector<RunName> order = order_of(planned(before), before);
  const std::vector<Look> looks = looks_of(order.size());
  const auto is_certain_at = [&](std::size_t look) {
    return is_certain(compare_all(before, at_look(before, order, looks[look])), looks, look);
  };
  EXPECT_FALSE(is_certain_at(0));
  EXPECT_FALSE(is_certain_at(1));
  EXPECT_TRUE(is_certain_at(2)) << "30 of 60 worlds are equal to the last bit";
}

TEST(Looks, RaiseNoMoreFalseAlarmsThanOneLookAndTakeFewerRuns) {
  std::mt19937 random(7);
  int alarms = 0;
  double share = 0;
  constexpr int kPairs = 200;
  for (int i = 0; i < kPairs; ++i) {
    const SuiteResult before = noise(60, 1, true, random), after = noise(60, 1, true, random);
    const std::vector<RunName> order = order_of(planned(before), before);
    const std::vector<Look> looks = looks_of(order.size());
    for (std::size_t k = 0;; ++k) {
      const Comparison comparison = compare_all(before, at_look(after, order, looks[k]));
      if (k + 1 < looks.size() && !is_certain(comparison, looks, k)) continue;
      alarms += comparison.has_regressed();
      share += static_cast<double>(looks[k].runs) / 60 / kPairs;
      break;
    }
  }
  EXPECT_LE(alarms, 12);  // as of SuitesThatDifferByNoiseAloneSeldomRegress
  EXPECT_LE(share, 0.6);
}

TEST(Looks, AStoppedSuiteIsStoredAndSaysHowFarItGot) {
  const test::TemporaryFolder folder;
  SuiteResult suite = suite_with({scenario_with("near", "rebel.f1", {0.5})});
  suite.sequential = {{1, 0.0125}, 3};
  write_suite(folder.path() / kSuiteFile, suite);
  const SuiteResult back = read_suite(folder.path());
  ASSERT_TRUE(back.sequential);
  EXPECT_EQ(back.sequential->look.runs, 1u);
  EXPECT_EQ(back.sequential->look.level, 0.0125);
  EXPECT_EQ(back.sequential->planned, 3u);
  const SuiteResult before = suite_with({scenario_with("near", "rebel.f1", {0.5, 0.6, 0.7})});
  const Comparison comparison = compare_all(before, back);
  const SuiteVerdict verdict = verdict_of({back, ""}, nullptr, &comparison);
  EXPECT_NE(verdict.line.find("after 1 of 3 runs"), std::string::npos) << verdict.line;
}

}  // namespace
}  // namespace lcs::suite
