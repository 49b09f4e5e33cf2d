// Drives past a wall of corners, some of which move sideways, and prints the detected rebels.
#include <cstdio>
#include <vector>

#include "filter/filter.h"
#include "filter/paper/paper_filter.h"

int main() {
  const lcs::Intrinsics camera{300, {159.5, 119.5}, 320, 240};
  std::vector<Eigen::Vector3d> points_m;  // in the camera's frame
  for (int i = 0; i < 80; ++i) points_m.emplace_back(0.5 * (i % 10) - 2.3, 0.4 * (i / 10) - 1.4, 6);
  const std::size_t walls = points_m.size();
  for (int i = 0; i < 9; ++i) points_m.emplace_back(0.2 * (i % 3) + 0.1, 0.2 * (i / 3) - 0.1, 4);

  lcs::EgoMotion motion;
  motion.dt_s = 0.1;
  motion.v_C_mps = {0, 0, 0.5};
  lcs::Filter filter(camera);
  lcs::paper::PaperFilter paper(camera);
  std::size_t found = 0, false_rebels = 0;
  for (int k = 0; k < 10; ++k) {
    std::vector<Eigen::Vector2f> corners_px;
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      if (k > 0) points_m[i] -= motion.dt_s * motion.v_C_mps;
      if (k > 0 && i >= walls) points_m[i].x() -= motion.dt_s * 0.6;
      const lcs::Vec2 px =
          camera.focal_px * points_m[i].head<2>() / points_m[i].z() + camera.centre_px;
      corners_px.push_back(px.cast<float>());
    }
    const lcs::EgoMotion since_last = k > 0 ? motion : lcs::EgoMotion{};
    paper.step(corners_px, since_last);
    const lcs::FrameResult& result = filter.step(corners_px, since_last);
    found = false_rebels = 0;
    for (std::size_t i = 0; i < corners_px.size(); ++i) {
      if (result.verdicts[i] == lcs::Verdict::rebel) ++(i < walls ? false_rebels : found);
    }
  }
  std::printf("%zu of 9 movers found, %zu of the wall's\n", found, false_rebels);
  return found >= 7 && false_rebels == 0 ? 0 : 1;
}
