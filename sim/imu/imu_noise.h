/// \file
/// Noise of the inertial and wheel sensors.
///
/// IMU: Kalibr's model (as in OpenVINS). At step dt = 1 / rate, for each axis,
///
///     measured_k = true_k + b_k + sigma / sqrt(dt) * N(0, 1)
///     b_0 = beta * N(0, 1),   b_k = b_{k-1} + sigma_b * sqrt(dt) * N(0, 1)
///
/// with sigma the noise density, sigma_b the random walk and beta the turn-on bias of
/// `scenario::ImuNoise`. White noise, walk and turn-on bias of each sensor have separate random
/// streams: changing one parameter leaves the numbers drawn for the others unchanged.
///
/// `true_k` is the reading with the errors of `scenario::Gyroscopes` and `Accelerometers`; ranges
/// and resolutions apply to the sum.
///
/// Wheel odometry: a scale drawn once per run, and white noise in x and y of B and in the yaw rate.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "scenarios/scenario.h"
#include "sim/base/random.h"
#include "sim/imu/imu.h"

namespace lcs::sim {

/// White noise and a random-walk bias on three axes.
class Noise3 {
 public:
  /// \throws std::invalid_argument unless the parameters are finite and >= 0, and the rate is > 0.
  Noise3(double density, double random_walk, double turn_on_bias, double rate_hz,
         std::uint64_t seed, std::string_view name);

  Eigen::Vector3d corrupt(const Eigen::Vector3d& truth);

  /// b_k of the last corrupted sample.
  const Eigen::Vector3d& bias() const { return bias_; }

 private:
  double white_step_;  ///< sigma / sqrt(dt)
  double walk_step_;   ///< sigma_b * sqrt(dt)
  RandomStream white_;
  RandomStream walk_;
  Eigen::Vector3d bias_;
  bool started_ = false;
};

class ImuNoiseModel {
 public:
  /// \param name of the IMU; two names in one run draw different noise.
  /// \throws std::invalid_argument as for `Noise3`.
  ImuNoiseModel(const scenario::Imu& imu, std::uint64_t seed, std::string_view name = "imu0");

  /// \param truth in the IMU's frame. Samples must be passed in order, without omission, 1 / rate
  /// apart.
  ImuSample corrupt(const ImuSample& truth);

  /// \name Biases of the last corrupted sample.
  ///@{
  const Eigen::Vector3d& gyro_bias_radps() const { return gyro_.bias(); }
  const Eigen::Vector3d& accel_bias_mps2() const { return accel_.bias(); }
  ///@}

 private:
  scenario::Gyroscopes gyroscopes_;
  scenario::Accelerometers accelerometers_;
  Noise3 gyro_;
  Noise3 accel_;
};

class OdometryNoiseModel {
 public:
  /// \throws std::invalid_argument unless noise and scale error are finite and >= 0.
  OdometryNoiseModel(const scenario::Odometry& odometry, std::uint64_t seed,
                     std::string_view name = "odometry0");

  /// The wheels measure x and y of B and the yaw rate; z is 0.
  OdometrySample corrupt(const OdometrySample& truth);

 private:
  double noise_mps_;
  double yaw_noise_radps_;
  RandomStream white_;
  RandomStream yaw_white_;
  double scale_;
};

}  // namespace lcs::sim
