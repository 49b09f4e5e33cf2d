#include "tools/comparators/epipolar.h"

#include <algorithm>

#include "filter/kinematics/geometry.h"

namespace lcs::comparators {

MotionField exact_field(const Intrinsics& camera, const EgoMotion& motion) {
  constexpr double kNearest_m = 0.8;  // a static point is not nearer (README.md)
  return {camera, motion, {.rotation = RotationModel::homography, .nearest_depth_m = kNearest_m}};
}

EgoMotion turned_back(const EgoMotion& motion) {
  EgoMotion back;
  back.dt_s = motion.dt_s;
  back.R_cur_prev = motion.R_cur_prev.transpose();
  return back;
}

double epipolar_distance(const MotionField& field, const Vec2& now_px, const Vec2& before_px) {
  const Eigen::Vector3d displacement_C_m = field.displacement_C_m();
  // z_min holds in both frames: in reverse, the point was nearer in the earlier one.
  const double nearest_ratio = 1 / (1 / field.max_ratio() + std::max(0.0, -displacement_C_m.z()) /
                                                                field.reference_depth_m());
  // No static point lies below the ground, with slack for its tilt.
  const double ground_ratio = field.ground_ratio(now_px).value_or(0) - field.ground_slack();
  const double farthest_ratio = std::clamp(ground_ratio, 0.0, nearest_ratio);
  return distance_to_segment(before_px, field.earlier(now_px, farthest_ratio, displacement_C_m),
                             field.earlier(now_px, nearest_ratio, displacement_C_m));
}

CornerMotion epipolar_motion(const MotionField& field, double residual_px, const Vec2& now_px,
                             const Vec2& before_px) {
  return {.known = true,
          .off = epipolar_distance(field, now_px, before_px) > residual_px,
          .step_px = now_px - before_px};
}

}  // namespace lcs::comparators
