/// \file
/// Rigid transforms, named by their frames, and the pinhole camera.
#pragma once

#include <Eigen/Core>

namespace lcs::sim {

using Eigen::Vector3d;

/// T_AB maps the coordinates of a point from B to A: p_A = R p_B + p.
struct Pose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& x_B) const { return R * x_B + p; }
  Pose operator*(const Pose& T_BC) const { return {R * T_BC.R, R * T_BC.p + p}; }
  Pose inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
};

/// Pinhole with square pixels, no distortion. Camera frame C: x right, y down, z forward. Pixels: x
/// right, y down, (0, 0) at the centre of the top-left pixel.
struct Pinhole {
  double focal_px = 0;                                  ///< f = (H/2) / tan(fovy/2)
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< ((W-1)/2, (H-1)/2)
  int width_px = 0;
  int height_px = 0;

  /// \throws std::invalid_argument unless both sizes are positive and 0 < fovy < pi.
  static Pinhole from_fovy(int width_px, int height_px, double fovy_rad);

  /// Pixel of a point x_C with z > 0, in C.
  Eigen::Vector2d project(const Eigen::Vector3d& x_C) const {
    return focal_px * x_C.head<2>() / x_C.z() + centre_px;
  }
  /// Point in C at z-depth `depth_m` (along the optical axis, not along the ray) on a pixel's ray.
  Eigen::Vector3d back_project(const Eigen::Vector2d& px, double depth_m) const {
    const Eigen::Vector2d xy = (px - centre_px) / focal_px * depth_m;
    return {xy.x(), xy.y(), depth_m};
  }
};

}  // namespace lcs::sim
