#include "sim/imu/imu_noise.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>

namespace lcs::sim {
namespace {

double not_negative(double value, std::string_view what) {
  if (std::isfinite(value) && value >= 0) return value;
  throw std::invalid_argument(fmt::format("{} must be finite and not negative", what));
}

double positive_rate(double rate_hz) {
  if (std::isfinite(rate_hz) && rate_hz > 0) return rate_hz;
  throw std::invalid_argument("the rate of a sensor must be above 0 Hz");
}

Eigen::Vector3d normal3(RandomStream& stream) {
  Eigen::Vector3d v;
  for (double& x : v) x = stream.normal();
  return v;
}

/// \return the value as a converter gives it: a multiple of the resolution within the range.
Eigen::Vector3d read_out(Eigen::Vector3d value, const std::optional<double>& range,
                         const std::optional<double>& resolution) {
  if (!resolution) return range ? value.cwiseMax(-*range).cwiseMin(*range).eval() : value;
  Eigen::Array3d steps = (value / *resolution).array().round();
  if (range) {
    constexpr double kRounding = 1e-9;  // of a range that is a multiple of the resolution
    const double most = std::floor(*range / *resolution + kRounding);
    steps = steps.max(-most).min(most);
  }
  return *resolution * steps.matrix();
}

}  // namespace

Noise3::Noise3(double density, double random_walk, double turn_on_bias, double rate_hz,
               std::uint64_t seed, std::string_view name)
    : white_step_(not_negative(density, "a noise density") * std::sqrt(positive_rate(rate_hz))),
      walk_step_(not_negative(random_walk, "a random walk") / std::sqrt(rate_hz)),
      white_(seed, fmt::format("{}.white", name)),
      walk_(seed, fmt::format("{}.walk", name)) {
  RandomStream turn_on(seed, fmt::format("{}.turn_on", name));
  bias_ = not_negative(turn_on_bias, "a turn-on bias") * normal3(turn_on);
}

Eigen::Vector3d Noise3::corrupt(const Eigen::Vector3d& truth) {
  if (started_) bias_ += walk_step_ * normal3(walk_);
  started_ = true;
  return truth + bias_ + white_step_ * normal3(white_);
}

ImuNoiseModel::ImuNoiseModel(const scenario::Imu& imu, std::uint64_t seed, std::string_view name)
    : gyroscopes_(imu.gyroscopes),
      accelerometers_(imu.accelerometers),
      gyro_(imu.noise.gyroscope_noise_density, imu.noise.gyroscope_random_walk,
            imu.noise.gyroscope_turn_on_bias_radps, imu.rate_hz, seed,
            fmt::format("{}.gyro", name)),
      accel_(imu.noise.accelerometer_noise_density, imu.noise.accelerometer_random_walk,
             imu.noise.accelerometer_turn_on_bias_mps2, imu.rate_hz, seed,
             fmt::format("{}.accel", name)) {}

ImuSample ImuNoiseModel::corrupt(const ImuSample& truth) {
  const auto& [M, C_gyro_i, A, range_radps, resolution_radps] = gyroscopes_;
  ImuSample sample = truth;
  if (gyroscopes_ != scenario::Gyroscopes{}) {  // an identity would change the sign of a zero
    sample.gyro_radps = M * (C_gyro_i * truth.gyro_radps) + A * (C_gyro_i * truth.accel_mps2);
  }
  if (accelerometers_ != scenario::Accelerometers{}) {
    sample.accel_mps2 = accelerometers_.M * truth.accel_mps2;
  }
  sample.gyro_radps = read_out(gyro_.corrupt(sample.gyro_radps), range_radps, resolution_radps);
  sample.accel_mps2 = read_out(accel_.corrupt(sample.accel_mps2), accelerometers_.range_mps2,
                               accelerometers_.resolution_mps2);
  return sample;
}

OdometryNoiseModel::OdometryNoiseModel(const scenario::Odometry& odometry, std::uint64_t seed,
                                       std::string_view name)
    : noise_mps_(not_negative(odometry.noise_mps, "the odometry's noise")),
      yaw_noise_radps_(not_negative(odometry.yaw_noise_radps, "the odometry's noise of yaw")),
      white_(seed, fmt::format("{}.white", name)),
      yaw_white_(seed, fmt::format("{}.yaw white", name)),
      scale_(1 + not_negative(odometry.scale_error, "the odometry's scale error") *
                     RandomStream(seed, fmt::format("{}.scale", name)).normal()) {}

OdometrySample OdometryNoiseModel::corrupt(const OdometrySample& truth) {
  OdometrySample sample{truth.t_ns, Eigen::Vector3d::Zero()};
  for (int axis : {0, 1}) {
    sample.velocity_mps[axis] = scale_ * truth.velocity_mps[axis] + noise_mps_ * white_.normal();
  }
  if (truth.yaw_rate_radps) {
    sample.yaw_rate_radps = scale_ * *truth.yaw_rate_radps + yaw_noise_radps_ * yaw_white_.normal();
  }
  return sample;
}

}  // namespace lcs::sim
