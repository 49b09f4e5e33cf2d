/// \file
/// The biases and the upright direction from the readings of an IMU at rest.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "sim/imu/imu.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

struct Rest {
  std::int64_t from_ns = 0, until_ns = 0;  ///< the first reading, and the end of the rest
  Vector3d gyro_bias_radps = Vector3d::Zero();
  /// Along gravity only: a bias across it is indistinguishable from a tilt, and is taken for one.
  Vector3d accel_bias_mps2 = Vector3d::Zero();
  Eigen::Matrix3d R_WS = Eigen::Matrix3d::Identity();  ///< upright according to the accelerometer
  bool moved = false;  ///< the readings contradict the given duration of rest
};

/// \param readings by time.
/// \param said_s duration of rest from the first reading on, in seconds; absent: as long as the
///   readings are constant up to sensor noise, which must be a second at least.
/// \return absent if no duration is given and the IMU is not at rest.
std::optional<Rest> rest_at_start(std::span<const sim::ImuSample> readings,
                                  std::optional<double> said_s, double gravity_mps2);

/// Reports the rest that was found, and a contradiction with the given duration.
void tell_rest(const Rest& rest, Tally& tally);

}  // namespace lcs::replay
