#include "tools/replay/at_rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/base/rotation.h"

namespace lcs::replay {
namespace {

constexpr std::int64_t kPart_ns = 250'000'000;
constexpr std::size_t kFewestParts = 4;  // one second

/// Angular rate in rad/s, then acceleration in m/s^2.
using Both = Eigen::Matrix<double, 6, 1>;

/// Upper limits on bias and noise of a usable sensor.
constexpr double kMostBias_radps = 0.1, kMostBias_mps2 = 0.6;
constexpr double kMostNoise_radps = 0.05, kMostNoise_mps2 = 0.5;

/// Means of parts at rest differ by at most these deviations of their noise, or these changes.
constexpr double kDeviations = 5, kLeastChange_radps = 2e-3, kLeastChange_mps2 = 0.03;

struct Part {
  std::int64_t end_ns = 0;
  int count = 0;
  Both mean = Both::Zero(), noise = Both::Zero();  ///< the latter are deviations

  auto gyro() const { return mean.head<3>(); }
  auto accel() const { return mean.tail<3>(); }
};

Part part_of(std::span<const sim::ImuSample> readings) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> all(6, readings.size());
  Eigen::Index next = 0;
  for (const sim::ImuSample& one : readings) all.col(next++) << one.gyro_radps, one.accel_mps2;
  Part part{readings.back().t_ns, static_cast<int>(all.cols()), all.rowwise().mean()};
  part.noise = (all.colwise() - part.mean).array().square().rowwise().mean().sqrt();
  return part;
}

std::vector<Part> parts_of(std::span<const sim::ImuSample> readings) {
  std::vector<Part> parts;
  while (!readings.empty()) {
    const std::int64_t end_ns = readings.front().t_ns + kPart_ns;
    const auto end =
        std::ranges::find_if(readings, [&](const sim::ImuSample& r) { return r.t_ns >= end_ns; });
    const auto count = static_cast<std::size_t>(end - readings.begin());
    if (end == readings.end()) break;  // incomplete part
    parts.push_back(part_of(readings.first(count)));
    readings = readings.subspan(count);
  }
  return parts;
}

bool is_noise(const Part& part, double gravity_mps2) {
  return part.gyro().norm() <= kMostBias_radps &&
         std::abs(part.accel().norm() - gravity_mps2) <= kMostBias_mps2 &&
         part.noise.head<3>().maxCoeff() <= kMostNoise_radps &&
         part.noise.tail<3>().maxCoeff() <= kMostNoise_mps2;
}

bool is_same(const Part& a, const Part& b) {
  Both least;
  least << Vector3d::Constant(kLeastChange_radps), Vector3d::Constant(kLeastChange_mps2);
  const double of_means = std::sqrt(1.0 / a.count + 1.0 / b.count);
  return ((b.mean - a.mean).cwiseAbs().array() <=
          (kDeviations * of_means * a.noise).cwiseMax(least).array())
      .all();
}

/// Number of consecutive parts at rest, from the first one on.
std::size_t still_parts(const std::vector<Part>& parts, double gravity_mps2) {
  std::size_t still = 0;
  while (still < parts.size() && is_noise(parts[still], gravity_mps2) &&
         is_same(parts.front(), parts[still])) {
    ++still;
  }
  return still;
}

/// The mean of the middle half of the values of each axis.
Vector3d middle_mean(std::vector<Vector3d> values) {
  Vector3d mean = Vector3d::Zero();
  const auto cut = values.size() / 4;
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::sort(values, {}, [axis](const Vector3d& value) { return value[axis]; });
    for (std::size_t i = cut; i < values.size() - cut; ++i) mean[axis] += values[i][axis];
  }
  return mean / static_cast<double>(values.size() - 2 * cut);
}

Rest rest_of(std::span<const sim::ImuSample> readings, double gravity_mps2) {
  const Part all = part_of(readings);
  Rest rest{{readings.front().t_ns, {}, all.gyro()}, all.end_ns};
  if (all.accel().norm() > 0) {
    const Vector3d up = all.accel().normalized();
    rest.start.accel_bias_mps2 = all.accel() - gravity_mps2 * up;
    rest.start.state.q_WB = sim::least_rotation(up, Vector3d::UnitZ());
  }
  return rest;
}

}  // namespace

std::optional<Rest> rest_at_start(std::span<const sim::ImuSample> readings,
                                  std::optional<double> said_s, double gravity_mps2) {
  if (readings.empty()) return std::nullopt;
  const std::vector<Part> parts = parts_of(readings);
  const std::size_t still = still_parts(parts, gravity_mps2);
  std::int64_t until_ns = still > 0 ? parts[still - 1].end_ns : readings.front().t_ns;
  bool moved = false;
  if (said_s) {
    const std::int64_t still_until_ns = until_ns;
    until_ns = readings.front().t_ns + std::llround(1e9 * *said_s);
    moved = still < parts.size() && still_until_ns + kPart_ns < until_ns;
  } else if (still < kFewestParts) {
    return std::nullopt;
  }
  const auto end =
      std::ranges::find_if(readings, [&](const sim::ImuSample& r) { return r.t_ns > until_ns; });
  Rest rest =
      rest_of(readings.first(static_cast<std::size_t>(end - readings.begin())), gravity_mps2);
  rest.moved = moved;
  return rest;
}

bool Beginning::is_still() const {
  return rate_S_radps.norm() <= kMostBias_radps;
}

Beginning beginning_of(std::span<const sim::ImuSample> readings) {
  constexpr std::int64_t kSpan_ns = 500'000'000;
  std::vector<Vector3d> forces_mps2, rates_radps;
  Eigen::Quaterniond q_S0S = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const sim::ImuSample& reading = readings[i];
    if (reading.t_ns - readings.front().t_ns > kSpan_ns) break;
    if (i > 0) {
      const double dt_s = seconds(reading.t_ns - readings[i - 1].t_ns);
      const double turn_rad = reading.gyro_radps.norm() * dt_s;
      q_S0S = q_S0S * Eigen::Quaterniond(
                          Eigen::AngleAxisd(turn_rad, reading.gyro_radps.stableNormalized()));
    }
    forces_mps2.push_back(q_S0S * reading.accel_mps2);
    rates_radps.push_back(reading.gyro_radps);
  }
  return {middle_mean(forces_mps2), middle_mean(rates_radps), static_cast<int>(rates_radps.size())};
}

TrueState start_of(std::span<const sim::ImuSample> readings, const RecordingSource& asked,
                   const Eigen::Matrix3d& R_BC, double gravity_mps2, bool is_upright,
                   Tally& tally) {
  if (readings.empty()) {
    refuse({},
           "the IMU has no reading from the first picture on; give both the times of one clock");
  }
  const double speed_mps = asked.speed_mps.value_or(0);
  // A speed rules out a rest that nobody states.
  const auto rest = speed_mps != 0 && !asked.at_rest_s
                        ? std::nullopt
                        : rest_at_start(readings, asked.at_rest_s, gravity_mps2);
  TrueState start;
  start.t_ns = readings.front().t_ns;
  if (rest) {
    const std::string until = fmt::format("of {:.2f} s", seconds(rest->until_ns - start.t_ns));
    tally.add("times at rest at the start give the IMU's biases and what is upright", until);
    if (rest->moved) {
      tally.add("times that at_rest names are not at rest, as the IMU says; shorten it", until);
    }
    start = rest->start;
  } else if (!is_upright) {
    const Beginning beginning = beginning_of(readings);
    const bool is_at_rest = speed_mps == 0 && beginning.is_still();
    tally.add(
        is_at_rest
            ? "recordings have no truth to start from: at rest, upright as the accelerometer says"
            : "recordings start while they move: upright as the accelerometer says, and the "
              "gyroscope's bias counts as 0",
        fmt::format("{} readings", beginning.count));
    start.state.q_WB = sim::least_rotation(beginning.up_S_mps2, Vector3d::UnitZ()).normalized();
    if (is_at_rest) start.gyro_bias_radps = beginning.rate_S_radps;
  }
  start.state.v_WB_mps = speed_mps * (start.state.q_WB.toRotationMatrix() * R_BC.col(2));
  return start;
}

}  // namespace lcs::replay
