#include "tools/suite/tables.h"

#include <gtest/gtest.h>

#include "tests/tools/suites.h"

namespace lcs::suite {
namespace {

SuiteResult suite_by(const std::string& detector, std::vector<ScenarioResult> scenarios) {
  SuiteResult suite = suite_with(std::move(scenarios));
  suite.detector = detector;
  return suite;
}

ScenarioResult scenario(const std::string& name, const std::vector<std::optional<double>>& f1s,
                        double step_ms) {
  ScenarioResult result = scenario_with(name, "rebel.f1", f1s);
  for (RunResult& run : result.runs) run.metrics.emplace_back("time.filter_ms_median", step_ms);
  return result;
}

TEST(BesideTable, HasMeansOverSeedsAndWhereTheSuiteIsLeastAhead) {
  const SuiteResult suite = suite_by("lcs", {scenario("near", {0.8, 0.9}, 1),
                                             scenario("far", {0.5}, 1), scenario("lab", {{}}, 9)});
  const std::vector<SuiteResult> others{
      suite_by("klt", {scenario("near", {0.6, 0.6}, 2), scenario("far", {0.5625}, 4),
                       scenario("lab", {{}}, 9)}),
      suite_by("homography", {scenario("far", {0.25}, 4), scenario("near", {0.6, 0.7}, 8),
                              scenario("lab", {0.1}, 9)})};
  EXPECT_EQ(
      beside_table(suite, others),
      "F1           lcs   klt  homography\n"
      "near        0.85  0.60        0.65\n"
      "far         0.50  0.56        0.25\n"
      "= mean (2)  0.68  0.58        0.45\n"
      "lcs is ahead of klt in 1 of 2, least in far (-0.062); takes 0.58 of its time\n"
      "lcs is ahead of homography in 2 of 2, least in near (+0.200); takes 0.46 of its time\n");
}

TEST(StandingPage, HasARowForEachDetectorOverWhatItHas) {
  // .8 and .5: .65 +- 12.706 * .2121 / sqrt(2)
  SuiteResult suite = suite_by(
      "lcs", {scenario("near", {0.8}, 1), scenario("far", {0.5}, 2), scenario("c", {}, 3)});
  SuiteResult other = suite_by("klt", {scenario("near", {0.6, 0.7}, 3)});
  other.scenarios[0].runs[0].metrics.emplace_back("time.process_ms_median", 7);
  const std::string head =
      "| detector | recall | F1 | false corners (per frame) | false (per 100 frames) | boxed "
      "movers | HOTA | detected | J&F | box latency (ms) | filter (ms) | process (ms) "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  const std::vector<SuiteResult> others{other};
  EXPECT_EQ(standing_page(suite, others),
            head +
                "| `lcs` | - | 0.650 | - | - | - | - | - | - | - | 1.5 | - |\n"
                "| `klt` | - | 0.650 | - | - | - | - | - | - | - | 3.0 | 7.0 |\n"
                "\nMeans over 3 scenarios; F1 and recall over the "
                "2 with F1.\n");
  for (ScenarioResult& world : suite.scenarios) world.drawn = Drawn{"room", 0, {}};
  EXPECT_NE(standing_page(suite, others).find("| `lcs` | - | 0.650±1.906 |"), std::string::npos)
      << standing_page(suite, others);
}

TEST(BesideTable, HasARowForEachGroupThatIsNotAll) {
  SuiteResult suite =
      suite_by("lcs", {scenario("a", {0.8}, 1), scenario("b", {0.6}, 1), scenario("c", {0.1}, 1)});
  suite.scenarios[0].groups = {"world", "room"};
  suite.scenarios[1].groups = {"world", "yard"};
  suite.scenarios[2].groups = {"world", "yard"};
  const SuiteResult other =
      suite_by("klt", {scenario("a", {0.5}, 1), scenario("b", {0.4}, 1), scenario("c", {0.2}, 1)});
  EXPECT_EQ(beside_table(suite, {{other}}),
            "F1           lcs   klt\n"
            "a           0.80  0.50\n"
            "b           0.60  0.40\n"
            "c           0.10  0.20\n"
            "= room (1)  0.80  0.50\n"
            "= yard (2)  0.35  0.30\n"
            "= mean (3)  0.50  0.37\n"
            "lcs is ahead of klt in 2 of 3, least in c (-0.100); takes 1.00 of its time\n");
}

TEST(BesideTable, OfWorldsHasTheIntervalOfEachMeanAndOfThePairedDifferenceByFamily) {
  // lcs is ahead of klt by .1, .2 and .3: .2 +- 4.3027 * .1 / sqrt(3)
  const auto world = [](const std::string& name, double f1, const std::string& family) {
    ScenarioResult result = scenario(name, {f1}, 1);
    result.groups = {"world", family};
    result.drawn = Drawn{family, 0, {}};
    result.runs[0].metrics.emplace_back("rebel.false_objects_per_100_frames", 10 * f1);
    return result;
  };
  const auto still = [](const std::string& name, double false_objects) {
    ScenarioResult result = scenario_with(name, "rebel.f1", {std::nullopt});
    result.groups = {"world", "yard", "static"};
    result.drawn = Drawn{"yard", 0, {}};
    result.runs[0].metrics.emplace_back("rebel.false_corners_per_frame", false_objects / 10);
    result.runs[0].metrics.emplace_back("rebel.false_objects_per_100_frames", false_objects);
    return result;
  };
  const SuiteResult suite =
      suite_by("lcs", {world("a", 0.5, "room"), world("b", 0.7, "yard"), world("c", 0.9, "yard"),
                       still("d", 3), still("e", 5)});
  const SuiteResult other =
      suite_by("klt", {world("a", 0.4, "room"), world("b", 0.5, "yard"), world("c", 0.6, "yard"),
                       still("d", 20), still("e", 20)});
  EXPECT_EQ(beside_table(suite, {{other}}),
            "F1           lcs        klt\n"
            "a           0.50       0.40\n"
            "b           0.70       0.50\n"
            "c           0.90       0.60\n"
            "= room (1)  0.50       0.40\n"
            "= yard (2)  0.80±1.27  0.55±.64\n"
            "= mean (3)  0.70±.50   0.50±.25\n"
            "lcs ahead by     klt\n"
            "= room (1)    +0.100\n"
            "= yard (2)    +0.250±.635\n"
            "= mean (3)    +0.200±.248\n"
            "false corners (per frame)  lcs      klt\n"
            "= static (2)               0.4±1.3  2.0\n"
            "= mean (2)                 0.4±1.3  2.0\n"
            "false (per 100 frames)  lcs       klt\n"
            "= static (2)            4.0±13   20.0\n"
            "= mean (5)              5.8±2.8  11.0±10\n"
            "±: 95 % interval of the mean over worlds; ahead: by world, and then the mean\n"
            "lcs is ahead of klt in 3 of 3, least in a (+0.100); takes 1.00 of its time\n");
}

TEST(BesideTable, LeavesOutWhatOneOfThemHasNotAndSaysSoWhereNothingIsLeft) {
  const SuiteResult suite =
      suite_by("lcs", {scenario("near", {0.8}, 1), scenario("far", {0.5}, 1)});
  const SuiteResult other = suite_by("klt", {scenario("far", {0.5}, 0)});
  EXPECT_EQ(beside_table(suite, {{other}}),
            "F1           lcs   klt\n"
            "far         0.50  0.50\n"
            "= mean (1)  0.50  0.50\n"
            "lcs is ahead of klt in 0 of 1, least in far (+0.000)\n");
  EXPECT_EQ(beside_table(suite, {{suite_by("klt", {})}}),
            "no scenario has an F1 by every detector\n");
}

}  // namespace
}  // namespace lcs::suite
