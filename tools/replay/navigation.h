/// \file
/// Shared by readers of navigation units: attitudes from angles, and a camera's mounting.
#pragma once

#include <Eigen/Geometry>

#include "filter/ego_motion/intake.h"

namespace lcs::replay {

/// R = Rz(yaw) Ry(pitch) Rx(roll).
inline Eigen::Quaterniond from_rpy(double roll, double pitch, double yaw) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

/// Whether a vehicle can have this velocity; larger values come from a corrupt file.
inline bool is_speed(double x_mps, double y_mps, double z_mps) {
  return Eigen::Vector3d(x_mps, y_mps, z_mps).norm() <= kMostSpeed_mps;
}

/// R_BC of a camera mounted by roll, pitch and yaw about the fixed axes of B (x ahead, y left, z
/// up), as `scenario::Camera::mount_rpy_rad`. All 0: it looks along x, upright.
inline Eigen::Matrix3d camera_mount(const Eigen::Vector3d& rpy_rad) {
  Eigen::Matrix3d ahead;  // C's z is B's x, its x is -y, its y is -z
  ahead << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return from_rpy(rpy_rad.x(), rpy_rad.y(), rpy_rad.z()).toRotationMatrix() * ahead;
}

}  // namespace lcs::replay
