/// \file
/// What the rover's inertial and wheel sensors say. Times are nanoseconds since the start of the
/// run: sample i of a sensor is at i / rate.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lcs::sim {

/// One reading, in the IMU's frame S. At rest the accelerometer reads +9.81 m/s^2 upwards.
struct ImuSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();
};

/// Velocity of the rover's frame B, in B, as its wheels tell it.
struct OdometrySample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
};

}  // namespace lcs::sim
