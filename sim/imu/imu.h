/// \file
/// Readings of the rover's inertial and wheel sensors. Times are nanoseconds since the start of the
/// run; sample i of a sensor has time i / rate.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/base/pose.h"

namespace lcs::sim {

/// One reading, in the IMU's frame S: the mean over the time since the reading before, as of a unit
/// that integrates its rates. With R and v the attitude and velocity of S in W at two readings, dt
/// apart, and g the gravity along -z,
///
///     gyro_k = Log(R_{k-1}^T R_k) / dt
///     accel_k = R_m^T ((v_k - v_{k-1}) / dt + g z),   R_m = R_{k-1} Exp(gyro_k dt / 2)
///
/// plus noise, so that integration over (t_{k-1}, t_k] by the mid attitude is exact. The first
/// reading, at 0, is of that instant. With `imu.reading: sample` all are of their instants: body
/// rate and specific force R_k^T (a_k + g z). At rest the accelerometer reads +9.81 m/s^2 upwards.
struct ImuSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();
};

/// The truth at the time of an IMU reading. Readings that a gap drops have one, too.
struct ImuTruth {
  std::int64_t t_ns = 0;
  Pose T_WS;
  Eigen::Vector3d v_WS_mps = Eigen::Vector3d::Zero();         ///< velocity of S, in W
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();  ///< bias of this reading, in S
  Eigen::Vector3d accel_bias_mps2 = Eigen::Vector3d::Zero();  ///< likewise
};

/// Velocity of the rover's frame B, in B, as the wheels measure it, including their slip.
struct OdometrySample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  /// Counter-clockwise, from the difference of the wheels; absent where wheels do not measure it.
  std::optional<double> yaw_rate_radps = std::nullopt;
};

/// A frame's number and time, and the readings that belong to it.
struct FrameReadings {
  int index = 0;          ///< k, from 0
  std::int64_t t_ns = 0;  ///< k / rate, from 0, by the clock of the IMU
  /// t(k-1) < t <= t(k), with the times of frames that the filter is told (`time_offset_error` of
  /// `camera.told`); the first frame has the sample at 0.
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;  ///< at the same times; empty if disabled
  std::vector<ImuTruth> imu_truth;       ///< at the times of `imu`, and in its gaps
};

}  // namespace lcs::sim
