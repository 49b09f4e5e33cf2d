/// \file
/// The rotation between two directions, and the rotation by roll, pitch and yaw.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace lcs::sim {

/// The smallest rotation from direction `from` to `to`. Eigen's own `FromTwoVectors` uses, for half
/// a turn, a decomposition that GCC 13 warns of.
inline Eigen::Quaterniond least_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond q;
  if (cosine < -1 + Eigen::NumTraits<double>::dummy_precision()) {
    q.coeffs() << a.cross(a.unitOrthogonal()), 0;  // half a turn of z about x, as in MuJoCo
  } else {
    const double twice_w = std::sqrt((1 + cosine) * 2);
    q.coeffs() << a.cross(b) * (1 / twice_w), twice_w * 0.5;
  }
  return q;
}

/// Roll, pitch and yaw about fixed x, y, z in this order: R = Rz(yaw) Ry(pitch) Rx(roll).
inline Eigen::Quaterniond quaternion_of_rpy(const Eigen::Vector3d& rpy_rad) {
  return Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX());
}
inline Eigen::Matrix3d rotation_of_rpy(const Eigen::Vector3d& rpy_rad) {
  return quaternion_of_rpy(rpy_rad).toRotationMatrix();
}

}  // namespace lcs::sim
