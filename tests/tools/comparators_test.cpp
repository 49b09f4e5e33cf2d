#include <gtest/gtest.h>

#include <stdexcept>

#include "scenarios/load.h"
#include "tools/bench/bench.h"
#include "tools/bench/recording_io.h"
#include "tools/bench/scoring.h"
#include "tools/comparators/detectors.h"

namespace lcs::comparators {
namespace {

using bench::Recording;

Recording run(std::string_view name, const char* file, std::vector<std::string> sets = {}) {
  const scenario::Scenario scenario = scenario::load(std::string(LCS_SCENARIOS_DIR "/") + file,
                                                     {.sets = std::move(sets), .seed = {}});
  sim::Simulation simulation(scenario);
  const auto tracker = detector(name).make(simulation.calibration().camera, scenario);
  Recording recording = bench::begin_recording(scenario, simulation);
  bench::run(scenario, simulation, *tracker, recording,
             [](const bench::FrameRecord&, const cv::Mat3b&) {});
  return recording;
}

TEST(Detectors, AreKnownByNameAndOthersAreRefusedWithTheListOfThem) {
  for (const Detector& each : detectors()) EXPECT_EQ(&detector(each.name), &each);
  try {
    detector("yolo");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "no detector is called 'yolo'; there are lcs, klt, homography");
  }
}

class EachDetector : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Names, EachDetector, testing::Values("lcs", "klt", "homography"),
                         [](const auto& test) { return test.param; });

TEST_P(EachDetector, SaysTheSameToTheLastBitInTwoRuns) {
  const Recording a = run(GetParam(), "crossing.yaml", {"frames=6"});
  const Recording b = run(GetParam(), "crossing.yaml", {"frames=6"});
  ASSERT_EQ(a.frames.size(), 6u);
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    EXPECT_EQ(a.frames[k].verdicts.size(), a.frames[k].corners_px.size());
    EXPECT_EQ(layers_line(a.frames[k]), layers_line(b.frames[k]));
  }
}

}  // namespace
}  // namespace lcs::comparators
