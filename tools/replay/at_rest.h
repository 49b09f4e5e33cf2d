/// \file
/// What the readings of an IMU that stands tell: its biases, and which way is up.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "sim/imu.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

struct Rest {
  std::int64_t until_ns = 0;  ///< as long it stood, from the first reading on
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  /// Along gravity alone: across it a bias looks like a tilt, and is taken for one.
  Eigen::Vector3d accel_bias_mps2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WS = Eigen::Matrix3d::Identity();  ///< upright, as the accelerometer says
  bool moved = false;  ///< it was said to stand so long, and the readings say otherwise
};

/// \param readings by time. \param said_s for how long it stands, from the first reading on; none:
///   as long as all readings are a mean and noise, which is no more than sensors have, if that is a
///   second at least.
/// \return none where nobody said that it stands and it does not.
std::optional<Rest> rest_at_start(std::span<const sim::ImuSample> readings,
                                  std::optional<double> said_s, double gravity_mps2);

/// Says what was found at rest, and what of it contradicts what was said.
void tell_rest(const Rest& rest, Tally& tally);

}  // namespace lcs::replay
