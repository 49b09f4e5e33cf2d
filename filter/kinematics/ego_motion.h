/// \file
/// The camera's motion between two frames: input of the filter.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace lcs {

/// The ground plane under the vehicle, in the camera frame of k.
struct Ground {
  Eigen::Vector3d up_C = -Eigen::Vector3d::UnitY();  ///< unit normal, against gravity
  double height_m = 0;                               ///< of the camera above the plane, > 0

  /// 1/m: inverse depth of the plane at image coordinates h = (x - centre) / focal length; negative
  /// above the horizon.
  double inverse_depth_pm(const Eigen::Vector2d& h) const {
    return -(up_C.head<2>().dot(h) + up_C.z()) / height_m;
  }
};

/// Motion of the camera from frame k-1 to frame k.
struct EgoMotion {
  double dt_s = 0;  ///< t_f; 0 in the first frame
  /// Takes camera coordinates from frame k-1 to frame k (rotation part).
  Eigen::Matrix3d R_cur_prev = Eigen::Matrix3d::Identity();
  /// Mean velocity of the camera over the interval, in the camera frame of k.
  Eigen::Vector3d v_C_mps = Eigen::Vector3d::Zero();
  /// Mean body rate of the camera over the interval, in the camera frame:
  /// R_cur_prev = exp(-[w] dt).
  Eigen::Vector3d w_C_radps = Eigen::Vector3d::Zero();
  /// rad: standard deviation of the rotation about each axis, due to missing gyro readings; 0 if
  /// none is missing.
  double unseen_turn_rad = 0;
  /// Standard deviation of the velocity along each axis, by the estimator. It grows while the IMU
  /// is integrated without odometry. 0 where unknown.
  double velocity_sigma_mps = 0;
  /// At frame k; absent where the camera's mounting is unknown.
  std::optional<Ground> ground;
};

}  // namespace lcs
