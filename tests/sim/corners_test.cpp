// Corners of the detector in the project's scenes: their number, their repeatability, and whether
// the true motion agrees with an independent detector.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "sim/simulation.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using scenario::Shape;
using test::fast_corners;
using test::line_actor;
using test::median;
using test::scenario_in;

constexpr double kMinDepth = 0.5;

/// The paper's run through the lab: 3 cm/s and 0.05 cm/s^2, one frame per second.
scenario::Scenario slow_lab() {
  auto s = scenario_in("lab", 0.03, 37);
  s.ego.phases[0].acceleration_mps2 = 0.0005;
  s.camera.rate_hz = 1;
  return s;
}

/// 0.5 m/s at 10 frames/s, a box and a pedestrian crossing.
scenario::Scenario fast_lab() {
  auto s = scenario_in("lab", 0.5, 60);
  s.actors = {line_actor("box", Shape::box, {0.5, -2}, 90 * test::kDegree, 0.5),
              line_actor("walker", Shape::pedestrian, {2, 2}, -90 * test::kDegree, 0.6)};
  s.actors[0].size_m = Eigen::Vector3d(0.5, 0.5, 0.6);
  return s;
}

scenario::Scenario street(int frames, double speed_mps) {
  auto s = scenario_in("street", speed_mps, frames);
  s.ego.start_m = {-9, 0};
  s.camera.width_px = 1280;
  s.camera.height_px = 960;
  return s;
}

struct Range {
  std::size_t least = 1'000'000, most = 0;
};

Range corner_counts(const scenario::Scenario& s) {
  Simulation simulation(s);
  Range range;
  while (const auto o = simulation.next()) {
    const std::size_t count = fast_corners(o->image, 20).size();
    range.least = std::min(range.least, count);
    range.most = std::max(range.most, count);
  }
  fmt::print("{} to {} corners\n", range.least, range.most);
  return range;
}

TEST(Corners, OfTheSlowRunThroughTheLabAre250To550) {
  const Range range = corner_counts(slow_lab());
  EXPECT_GE(range.least, 250u);
  EXPECT_LE(range.most, 550u);
}

TEST(Corners, OfTheFastRunThroughTheLabAre250To550) {
  const Range range = corner_counts(fast_lab());
  EXPECT_GE(range.least, 250u);
  EXPECT_LE(range.most, 550u);
}

TEST(Corners, OfTheStreetAreOver700) {
  EXPECT_GT(corner_counts(street(25, 10)).least, 700u);  // 24 m
}

/// Whether the depth changes by more than a tenth within 3 px.
bool at_depth_edge(const FrameTruth& truth, const Vector2f& corner) {
  const cv::Rect image(0, 0, truth.depth_m.cols, truth.depth_m.rows);
  const cv::Rect around(static_cast<int>(std::lround(corner.x())) - 3,
                        static_cast<int>(std::lround(corner.y())) - 3, 7, 7);
  double nearest = 0;
  double farthest = 0;
  cv::minMaxLoc(truth.depth_m(around & image), &nearest, &farthest);
  return farthest > 1.1 * nearest;
}

struct Share {
  int found = 0, all = 0;
  double value() const { return static_cast<double>(found) / all; }
};

struct Repeatability {
  Share off_edges, at_edges, movers;
  std::vector<double> error_px;  ///< of fixed corners that are detected again
};

/// Moves the corners of each frame by their true motion and matches them to the next frame's
/// within 1.5 px.
Repeatability repeatability(const scenario::Scenario& s) {
  constexpr double kReach = 1.5;
  constexpr double kBorder = 4;  // the detector needs a ring of 3 px
  Simulation simulation(s);
  struct Expected {
    Vector2d px;
    bool edge, mover;
  };
  std::vector<Expected> expected;
  Repeatability r;
  while (const auto o = simulation.next()) {
    const std::vector<Vector2f> corners = fast_corners(o->image, 20);
    for (const Expected& e : expected) {
      double nearest = 1e9;
      for (const Vector2f& c : corners)
        nearest = std::min(nearest, (c.cast<double>() - e.px).norm());
      Share& share = e.mover ? r.movers : e.edge ? r.at_edges : r.off_edges;
      ++share.all;
      share.found += nearest <= kReach;
      if (!e.mover && nearest <= kReach) r.error_px.push_back(nearest);
    }
    expected.clear();
    const auto truth = label_corners(simulation.calibration().camera, o->truth, corners, kMinDepth);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (truth[i].label == Label::none || truth[i].label == Label::indistinct) continue;
      const Vector2d px = corners[i].cast<double>() + truth[i].motion_px;
      const bool inside = px.x() > kBorder && px.y() > kBorder &&
                          px.x() < o->image.cols - 1 - kBorder &&
                          px.y() < o->image.rows - 1 - kBorder;
      if (!inside) continue;
      expected.push_back({px, at_depth_edge(o->truth, corners[i]), truth[i].label == Label::rebel});
    }
  }
  fmt::print("found again within 1.5 px: {:.3f} of {} off depth edges, {:.3f} of {} at them",
             r.off_edges.value(), r.off_edges.all, r.at_edges.value(), r.at_edges.all);
  if (r.movers.all > 0) fmt::print(", {:.3f} of {} on movers", r.movers.value(), r.movers.all);
  fmt::print("; median error {:.3f} px\n", median(r.error_px));
  return r;
}

// Repeatability of single textures off depth edges, at 1 cm per frame: 0.87 (few rectangles) to
// 0.78 (bricks); drawers, boards and labels are near the first, windows (0.81) near the second.
TEST(Corners, OfTheLabAreFoundAgain) {
  const Repeatability slow = repeatability(slow_lab());
  EXPECT_GE(slow.off_edges.value(), 0.84);
  EXPECT_GE(slow.at_edges.value(), 0.64);
  EXPECT_LE(median(slow.error_px), 0.5);
}

TEST(Corners, OfTheStreetAreFoundAgain) {
  const Repeatability r = repeatability(street(20, 0.1));
  EXPECT_GE(r.off_edges.value(), 0.79);
  EXPECT_LE(median(r.error_px), 0.5);
}

TEST(Corners, OfMoversAreFoundAgain) {
  const Repeatability r = repeatability(fast_lab());
  EXPECT_GE(r.off_edges.value(), 0.79);
  // limbs before changing ground: half of a mover's corners lie at depth edges
  EXPECT_GE(r.movers.value(), 0.64);
}

struct Tracked {
  std::vector<double> fixed_px, rebel_px;  ///< |detector - truth|
};

/// Truth against pyramidal Lucas-Kanade, off depth edges, where a window contains one motion.
/// Tracks that do not lead back to their start are the detector's errors.
Tracked against_tracker(const scenario::Scenario& s) {
  Simulation simulation(s);
  Tracked result;
  std::optional<Observation> last;
  cv::Mat1b last_grey;
  while (auto o = simulation.next()) {
    cv::Mat1b grey;
    cv::cvtColor(o->image, grey, cv::COLOR_BGR2GRAY);
    if (last) {
      std::vector<Vector2f> corners;
      for (const Vector2f& c : fast_corners(last->image, 20)) {
        if (!at_depth_edge(last->truth, c)) corners.push_back(c);
      }
      const auto truth =
          label_corners(simulation.calibration().camera, last->truth, corners, kMinDepth);
      std::vector<cv::Point2f> from, to, back;
      for (const Vector2f& c : corners) from.emplace_back(c.x(), c.y());
      std::vector<uchar> found, returned;
      cv::calcOpticalFlowPyrLK(last_grey, grey, from, to, found, cv::noArray(), {15, 15});
      cv::calcOpticalFlowPyrLK(grey, last_grey, to, back, returned, cv::noArray(), {15, 15});
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (!found[i] || !returned[i] || cv::norm(back[i] - from[i]) > 0.3) continue;
        const cv::Point2f flow = to[i] - from[i];
        const double error = (truth[i].motion_px - Vector2d(flow.x, flow.y)).norm();
        if (truth[i].label == Label::fixed) result.fixed_px.push_back(error);
        if (truth[i].label == Label::rebel) result.rebel_px.push_back(error);
      }
    }
    last_grey = grey;
    last = std::move(o);
  }
  fmt::print("detector against truth: median {:.3f} px of {} fixed", median(result.fixed_px),
             result.fixed_px.size());
  if (!result.rebel_px.empty()) {
    fmt::print(", {:.3f} px of {} rebels", median(result.rebel_px), result.rebel_px.size());
  }
  fmt::print("\n");
  return result;
}

// The project promises a median of 0.5 px. A detector on clean images errs by some hundredths, so
// a truth that is half a pixel off, or a frame late, exceeds 0.15.
TEST(TrueMotion, OfFixedCornersInTheLabIsWhatADetectorSees) {
  const Tracked t = against_tracker(slow_lab());
  ASSERT_GT(t.fixed_px.size(), 1000u);
  EXPECT_LE(median(t.fixed_px), 0.15);
}

TEST(TrueMotion, OfMoversIsWhatADetectorSees) {
  auto s = fast_lab();
  s.camera.rate_hz = 30;  // within reach of the detector's window
  const Tracked t = against_tracker(s);
  ASSERT_GT(t.fixed_px.size(), 1000u);
  ASSERT_GT(t.rebel_px.size(), 500u);
  EXPECT_LE(median(t.fixed_px), 0.15);
  EXPECT_LE(median(t.rebel_px), 0.15);
}

TEST(TrueMotion, InTheStreetIsWhatADetectorSees) {
  auto s = street(12, 1);
  s.actors = {line_actor("other", Shape::car, {9, 0.3}, 180 * test::kDegree, 1)};
  const Tracked t = against_tracker(s);
  ASSERT_GT(t.fixed_px.size(), 1000u);
  EXPECT_LE(median(t.fixed_px), 0.15);
}

TEST(TrueMotion, UnderYawAndRollOfTheCameraIsWhatADetectorSees) {
  auto s = scenario_in("lab", 0.3, 20);
  s.ego.phases[0].yaw_rate_radps = 0.2;
  s.camera.mount_rpy_rad = {0.3, -0.1, 0.05};
  const Tracked t = against_tracker(s);
  ASSERT_GT(t.fixed_px.size(), 500u);
  EXPECT_LE(median(t.fixed_px), 0.15);
}

}  // namespace
}  // namespace lcs::sim
