#include "tools/suite/verdict.h"

#include <gtest/gtest.h>

#include "tests/tools/suites.h"
#include "tests/tools/temporary_folder.h"
#include "tools/scoring/events.h"

namespace lcs::suite {
namespace {

namespace fs = std::filesystem;

SuiteVerdict verdict_against(const SuiteInFolder& after, const SuiteInFolder& before) {
  const Comparison comparison =
      compare(before.suite, after.suite, [](std::string_view) { return true; });
  return verdict_of(after, &before, &comparison);
}

scoring::JudgedCriterion criterion(bool met, bool required = true) {
  return {.metric = "rebel.f1",
          .min = 0.5,
          .max = {},
          .value = 0.4,
          .required = required,
          .met = met,
          .message = met ? "" : "rebel.f1 is 0.4, must be at least 0.5"};
}

TEST(SuiteVerdict, CountsScenariosAgainstABaselineAndCriteriaInOneLine) {
  const auto with = [](double worse, double better) {
    return suite_with({scenario_with("a", "rebel.f1", {worse, worse}),
                       scenario_with("b", "rebel.f1", {better, better}),
                       scenario_with("c", "rebel.f1", {0.5, 0.5})});
  };
  const SuiteResult before = with(0.8, 0.2);
  SuiteResult after = with(0.6, 0.4);
  EXPECT_EQ(
      verdict_against({after, {}}, {before, {}}).line,
      "no regression found, but 1 scenario regressed; of 1 mean 0 regressed, 0 improved; of 3 "
      "scenarios 1 regressed, 1 improved, 1 as before; 6 runs without an error, no criteria "
      "asked for");
  EXPECT_EQ(verdict_against({after, {}}, {before, {}}).light, Light::yellow);
  // A criterion counts once a seed.
  for (RunResult& run : after.scenarios[2].runs) {
    run.criteria = {criterion(false), criterion(true), criterion(false, false)};
    run.outcome = Outcome::failed;
  }
  after.scenarios.push_back(scenario_with("d", "rebel.f1", {0.5}));
  const SuiteVerdict verdict = verdict_against({after, {}}, {before, {}});
  EXPECT_EQ(
      verdict.line,
      "no regression found, but 1 scenario regressed, failed criteria and runs: 2; of 1 mean 0 "
      "regressed, 0 improved; of 4 scenarios 1 regressed, 1 improved, 1 as before, 1 not "
      "compared; 7 of 11 criteria met, 2 failed, 2 missed but not required")
      << "2 of the third scenario, and a run without criteria for each of the 5 others";
  EXPECT_EQ(verdict.light, Light::yellow);
  ASSERT_EQ(verdict.remarks.size(), 3u);
  EXPECT_EQ(
      verdict.remarks[0].reasons,
      std::vector<std::string>{"failed criterion, seed 1, rebel.f1 is 0.4, must be at least 0.5 "
                               "(fails with 2 of 2 seeds)"});
}

TEST(SuiteVerdict, IsRedWithoutABaselineOnlyIfACriterionFailed) {
  SuiteResult suite = suite_with({scenario_with("a", "rebel.f1", {0.5})});
  EXPECT_EQ(verdict_of({suite, {}}, nullptr, nullptr).light, Light::green);
  suite.scenarios[0].runs[0].criteria = {criterion(false)};
  const SuiteVerdict verdict = verdict_of({suite, {}}, nullptr, nullptr);
  EXPECT_EQ(verdict.light, Light::red);
  EXPECT_FALSE(verdict.finding);
}

TEST(SuiteVerdict, WithoutABaselineCountsCriteriaAndErrors) {
  SuiteResult suite = suite_with({scenario_with("a", "rebel.f1", {0.5})});
  EXPECT_EQ(verdict_of({suite, {}}, nullptr, nullptr).line,
            "1 run without an error, no criteria asked for");
  suite.scenarios[0].runs[0].criteria = {criterion(true), criterion(true)};
  suite.scenarios.push_back(scenario_with("b", "rebel.f1", {0.5}));
  suite.scenarios[1].runs[0] = {};
  suite.scenarios[1].runs[0].error = "no such scene";
  const SuiteVerdict verdict = verdict_of({suite, {}}, nullptr, nullptr);
  EXPECT_EQ(verdict.line, "2 of 3 criteria met, 0 failed, 1 run with an error");
  ASSERT_EQ(verdict.remarks.size(), 1u);
  EXPECT_EQ(verdict.remarks[0].standings, std::vector{Standing::error});
  EXPECT_EQ(verdict.remarks[0].reasons, std::vector<std::string>{"seed 0: no such scene"});
}

TEST(SuiteVerdict, TheWorstComesFirstWithItsReasons) {
  const auto with = [](double a, double b, double c) {
    return suite_with({scenario_with("a", "rebel.f1", {a, a}), scenario_with("b", "rebel.f1", {b}),
                       scenario_with("c", "rebel.f1", {c, c}),
                       scenario_with("d", "rebel.f1", {a})});
  };
  const SuiteResult before = with(0.8, 0.8, 0.8);
  SuiteResult after = with(0.9, 0.7, 0.3);
  after.scenarios[1].runs[0].criteria = {criterion(false)};
  after.scenarios[1].runs[0].outcome = Outcome::failed;
  EXPECT_EQ(
      text_of(verdict_against({after, {}}, {before, {}})),
      "failed, changed: b\n"
      "  failed criterion, seed 1, rebel.f1 is 0.4, must be at least 0.5\n"
      "  rebel.f1 0.800 -> 0.700\n"
      "passed, regressed: c\n"
      "  rebel.f1 0.800 -> 0.300 [-0.500, -0.500]\n"
      "passed, changed: d\n"
      "  rebel.f1 0.800 -> 0.900\n"
      "passed, improved: a\n"
      "  rebel.f1 0.800 -> 0.900 [+0.100, +0.100]\n"
      "each figure of a single scenario is judged by its own interval: of 2, chance alone changes "
      "up to 1; single scenarios with one seed have an unknown noise and no verdict; --seeds gives "
      "more\n");
}

class VerdictOnRules : public testing::Test {
 protected:
  /// A suite with one run with these events, in a folder called `name`.
  SuiteResult suite(const std::string& name, double f1,
                    const std::vector<scoring::ScoredEvent>& events) {
    SuiteResult made = suite_with({scenario_with("near", "rebel.f1", {f1})});
    made.scenarios[0].runs[0].folder = "run";
    fs::create_directories(folder_.path() / name / "run");
    scoring::write_events(folder_.path() / name / "run" / scoring::kEventsFile, events,
                          scoring::sums_of(events));
    return made;
  }
  static scoring::ScoredEvent event(bool missed, std::vector<std::pair<Reason, int>> reasons) {
    scoring::ScoredEvent event;
    event.kind = missed ? scoring::EventKind::lost : scoring::EventKind::false_alarm;
    event.counted_corners = missed ? 100 : 0;
    event.reasons = std::move(reasons);
    return event;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(VerdictOnRules, TheRuleThatTookMostNewRebelsIsNamed) {
  const SuiteResult before =
      suite("before", 0.8, {event(true, {{Reason::first_sighting, 50}, {Reason::normal_edge, 2}})});
  scoring::ScoredEvent split;
  split.kind = scoring::EventKind::square_split;
  split.frames = 40;
  const SuiteResult after = suite(
      "after", 0.6,
      {event(true, {{Reason::first_sighting, 60}, {Reason::normal_edge, 20}}),
       event(true, {{Reason::normal_edge, 5}}), event(false, {{Reason::inherited, 9}}), split});
  const SuiteVerdict verdict =
      verdict_against({after, folder_.path() / "after"}, {before, folder_.path() / "before"});
  ASSERT_EQ(verdict.remarks.size(), 1u);
  EXPECT_EQ(verdict.remarks[0].reasons,
            (std::vector<std::string>{
                "rebel.f1 0.800 -> 0.600",
                "most new misses by normal_edge (its track moved as a static point may): 2 -> 25 "
                "corners",
                "most new false rebels by inherited (likely a rebel by those round it): 0 -> "
                "9 corners",
                "most new wrong squares by square_split (several squares on it): 0 -> 40 "
                "object-frames"}));
}

TEST_F(VerdictOnRules, EventsThatAreNotThereOrCannotBeReadExplainNothing) {
  const SuiteResult before = suite("before", 0.8, {});
  const SuiteResult after = suite("after", 0.6, {event(true, {{Reason::first_sighting, 60}})});
  fs::remove_all(folder_.path() / "before");
  const SuiteVerdict verdict =
      verdict_against({after, folder_.path() / "after"}, {before, folder_.path() / "before"});
  EXPECT_EQ(verdict.remarks.at(0).reasons.size(), 1u);
}

}  // namespace
}  // namespace lcs::suite
