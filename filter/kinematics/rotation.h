/// \file
/// Rotation vectors (axis times angle, rad) and their matrices.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lcs {

/// skew(v) x = v x x.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

inline Eigen::Matrix3d exponential(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + skew(rotation_rad);
  return Eigen::AngleAxisd(angle, rotation_rad / angle).toRotationMatrix();
}

inline Eigen::Vector3d logarithm(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd axis_angle(R);
  return axis_angle.angle() * axis_angle.axis();
}

}  // namespace lcs
