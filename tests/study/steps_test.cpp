#include "tests/study/step_filter.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenarios/load.h"
#include "tools/bench/bench.h"
#include "tools/recording/recording_io.h"

namespace lcs::study {
namespace {

/// The verdicts and layers of each frame, as they are stored.
std::vector<std::string> lines_of(std::vector<recording::FrameRecord>& frames) {
  std::vector<std::string> lines;
  for (recording::FrameRecord& frame : frames) {
    frame.paper = {};
    frame.gaps.reset();
    frame.signatures.clear();
    lines.push_back(recording::layers_line(frame));
  }
  return lines;
}

/// Runs a scenario with the first and the last step, and the filters that they must equal.
void expect_same_as_the_filters(const std::string& scenario_file, const std::string& frames) {
  const scenario::Scenario scenario =
      scenario::load(LCS_SCENARIOS_DIR + scenario_file, {.sets = {"frames=" + frames}, .seed = {}});
  sim::Simulation simulation(scenario);
  const Intrinsics camera = bench::run_info(scenario, simulation).camera.value();
  StepDetector first(camera, rules_of(0)), last(camera, rules_of(kLastStep));
  bench::LcsDetector lab(camera, preset("lab")), ours(camera, preset("default"));
  std::vector<recording::FrameRecord> seen[4];
  std::vector<bench::DetectorRun> runs;
  bench::Detector* const detectors[] = {&first, &lab, &last, &ours};
  for (int i = 0; i < 4; ++i) {
    runs.push_back({*detectors[i], [&, i](const recording::FrameRecord& frame, const cv::Mat3b&) {
                      seen[i].push_back(frame);
                    }});
  }
  bench::run(scenario, simulation, runs);
  std::size_t rebels[2] = {0, 0};
  for (int pair = 0; pair < 2; ++pair) {
    for (const recording::FrameRecord& frame : seen[2 * pair]) {
      rebels[pair] += frame.layers.rebel_edges.size();
    }
    EXPECT_GT(rebels[pair], 0u);
    EXPECT_EQ(lines_of(seen[2 * pair]), lines_of(seen[2 * pair + 1]))
        << (pair == 0 ? "step 0 and lab" : "the last step and the default");
  }
}

TEST(StepsOfTheStudy, TheFirstIsTheLabAndTheLastTheDefault) {
  expect_same_as_the_filters("/crossing.yaml", "25");
}

TEST(StepsOfTheStudy, TheLastFindsRadialMoversToo) {
  expect_same_as_the_filters("/suite/approaching_head_on.yaml", "25");
}

TEST(StepsOfTheStudy, EachStepAddsOneRule) {
  EXPECT_FALSE(rules_of(0).no_psi);
  EXPECT_TRUE(rules_of(1).no_psi);
  EXPECT_FALSE(rules_of(1).velocity);
  EXPECT_FALSE(rules_of(kLastStep - 1).radial);
  EXPECT_TRUE(rules_of(kLastStep).radial);
  EXPECT_THROW(rules_of(kLastStep + 1), std::invalid_argument);
  EXPECT_TRUE(rules_named("velocity,gate,votes,").votes);
  EXPECT_FALSE(rules_named("velocity,gate,votes,").coupling);
  EXPECT_THROW(rules_named("votes,vote,"), std::invalid_argument);
  EXPECT_THROW(rules_named("gate,"), std::invalid_argument);
}

}  // namespace
}  // namespace lcs::study
