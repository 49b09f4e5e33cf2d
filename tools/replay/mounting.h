/// \file
/// Where a camera looks, by the angles that people give.
#pragma once

#include <Eigen/Geometry>

namespace lcs::replay {

/// R_BC of a camera mounted by roll, pitch and yaw about the fixed x, y and z of B (x ahead, y
/// left, z up), as `scenario::Camera::mount_rpy_rad`: all 0 looks along x, upright.
inline Eigen::Matrix3d camera_mount(const Eigen::Vector3d& rpy_rad) {
  Eigen::Matrix3d ahead;  // of C: its z is B's x, its x is -y, its y is -z
  ahead << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return (Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX()))
             .toRotationMatrix() *
         ahead;
}

}  // namespace lcs::replay
