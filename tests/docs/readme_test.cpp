// Runs the C++ example of the top README.md on a wall that the camera approaches, and a block that
// crosses it.
#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <vector>

#include "filter/filter.h"

namespace {

struct Frame {
  std::vector<Eigen::Vector2f> corners_px;
  lcs::EgoMotion motion;
};

std::vector<lcs::Square> reported;

void report(const lcs::Square& square) {
  reported.push_back(square);
}

#include "readme_example.inc"

TEST(Readme, ItsCppExampleReportsTheBlock) {
  const lcs::Intrinsics camera{300, {159.5, 119.5}, 320, 240};
  std::vector<Eigen::Vector3d> points_m;  // in the camera's frame
  for (int i = 0; i < 80; ++i) points_m.emplace_back(0.5 * (i % 10) - 2.3, 0.4 * (i / 10) - 1.4, 6);
  const std::size_t wall = points_m.size();
  for (int i = 0; i < 9; ++i) points_m.emplace_back(0.2 * (i % 3) + 0.1, 0.2 * (i / 3) - 0.1, 4);
  std::vector<Frame> frames(10);
  for (Frame& frame : frames) {
    if (&frame != &frames.front()) {
      frame.motion.dt_s = 0.1;
      frame.motion.v_C_mps = {0, 0, 0.5};
      for (std::size_t i = 0; i < points_m.size(); ++i) {
        points_m[i] -= frame.motion.dt_s * frame.motion.v_C_mps;
        if (i >= wall) points_m[i].x() -= frame.motion.dt_s * 0.6;
      }
    }
    for (const Eigen::Vector3d& point : points_m) {
      const lcs::Vec2 px = camera.focal_px * point.head<2>() / point.z() + camera.centre_px;
      frame.corners_px.push_back(px.cast<float>());
    }
  }
  reported.clear();
  watch(frames, camera);
  ASSERT_FALSE(reported.empty());
  // The block's middle corner in the last frame lies in the last square
  const lcs::Square& square = reported.back();
  const lcs::Vec2 middle = frames.back().corners_px[wall + 4].cast<double>();
  const lcs::Vec2 off = (middle - square.location).cwiseAbs();
  EXPECT_TRUE((off.array() <= square.half_size.array()).all()) << square.location.transpose();
}

}  // namespace
