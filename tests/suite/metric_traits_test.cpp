#include "tools/suite/metric_traits.h"

#include <gtest/gtest.h>

#include "tools/scoring/scoring.h"

namespace lcs::suite {
namespace {

TEST(MetricTraits, KnowEveryFigureOfARunInItsOrder) {
  std::vector<std::string> scored, known;
  for (const auto& [name, figure] : bench::score(bench::Recording{})) scored.push_back(name);
  for (const MetricTraits& traits : metric_traits()) known.emplace_back(traits.name);
  EXPECT_EQ(known, scored);
}

TEST(MetricTraits, JudgeNoTimeAndNothingThatTheRunWasGiven) {
  for (const MetricTraits& traits : metric_traits()) {
    const bool is_given = traits.name.starts_with("time.") || traits.name.starts_with("sim.") ||
                          traits.name.starts_with("truth.") || traits.name == "frames";
    if (is_given) {
      EXPECT_EQ(traits.direction, Direction::neutral) << traits.name;
    }
  }
}

TEST(MetricTraits, SayWhichWayIsBetter) {
  EXPECT_EQ(traits_of("rebel.f1").direction, Direction::higher);
  EXPECT_EQ(traits_of("rebel.latency_frames_median").direction, Direction::lower);
  EXPECT_EQ(traits_of("no.such_figure").direction, Direction::neutral);
  EXPECT_EQ(sign_of_change(Direction::higher, 0.5, 0.6), 1);
  EXPECT_EQ(sign_of_change(Direction::higher, 0.6, 0.5), -1);
  EXPECT_EQ(sign_of_change(Direction::lower, 0.5, 0.6), -1);
  EXPECT_EQ(sign_of_change(Direction::lower, 0.6, 0.5), 1);
  EXPECT_EQ(sign_of_change(Direction::higher, 0.5, 0.5), 0);
  EXPECT_EQ(sign_of_change(Direction::neutral, 0.5, 0.6), 0);
}

TEST(MetricTraits, TheLeastChangeIsAbsoluteForSharesAndRelativeForLargeCounts) {
  EXPECT_DOUBLE_EQ(least_change(traits_of("rebel.f1"), 0.9), 0.01);
  const MetricTraits false_objects = traits_of("rebel.false_objects_per_100_frames");
  EXPECT_DOUBLE_EQ(least_change(false_objects, 0), 1);
  EXPECT_DOUBLE_EQ(least_change(false_objects, 200), 10);
}

}  // namespace
}  // namespace lcs::suite
