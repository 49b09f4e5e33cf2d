/// \file
/// The start of dead reckoning from the first readings of an IMU: the upright direction, and at
/// rest the biases.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>

#include "sim/imu/imu.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

/// State of the body, with the biases of its IMU.
struct TrueState {
  std::int64_t t_ns = 0;
  NavigationState state;
  Vector3d gyro_bias_radps = Vector3d::Zero();
  Vector3d accel_bias_mps2 = Vector3d::Zero();
};

struct Rest {
  /// At the first reading, upright by the accelerometer. The bias of that is along gravity only:
  /// one across it is indistinguishable from a tilt, and is taken for one.
  TrueState start;
  std::int64_t until_ns = 0;
  bool moved = false;  ///< the readings contradict the given duration of rest
};

/// \param readings by time.
/// \param said_s duration of rest from the first reading on, in seconds; absent: as long as the
///   readings are constant up to sensor noise, which must be a second at least.
/// \return absent if no duration is given and the IMU is not at rest.
std::optional<Rest> rest_at_start(std::span<const sim::ImuSample> readings,
                                  std::optional<double> said_s, double gravity_mps2);

/// Up and rate at the first reading, by the readings of half a second. Each is the mean of the
/// middle half of the values, so that a bump or a wrong reading does not count.
struct Beginning {
  Vector3d up_S_mps2 = Vector3d::Zero();     ///< turned back to the first reading by the gyroscope
  Vector3d rate_S_radps = Vector3d::Zero();  ///< of the readings as they are
  int count = 0;                             ///< of the readings
  /// S is held still: the rate is one that a gyroscope's bias can have.
  bool is_still() const;
};

/// \param readings by time, from the start on; at least one.
Beginning beginning_of(std::span<const sim::ImuSample> readings);

/// The start at the first reading, and what is told of it: upright by the accelerometer, at rest
/// for the given or detected time, else at the given speed along the optical axis. \param readings
/// by time, at least one. \param is_upright the body's z is up unless a rest says
///   more exactly where up is.
TrueState start_of(std::span<const sim::ImuSample> readings, const RecordingSource& asked,
                   const Eigen::Matrix3d& R_BC, double gravity_mps2, bool is_upright, Tally& tally);

/// Sets the motion by dead reckoning from the start on, without its biases.
/// \param calibration without the start. \param readings from its time on, which is 0.
void move_from(const TrueState& start, sim::Calibration calibration, SensorReadings readings,
               Recorded& recorded);

}  // namespace lcs::replay
