#include "tools/replay/motion_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"

namespace lcs::replay {
namespace {

template <class Timed>
struct Around {
  const Timed &before, &after;  ///< the same one at its time, before the first and after the last
  double share = 0;             ///< of `after`
};
template <class Timed>
Around<Timed> around(std::int64_t t_ns, const std::vector<Timed>& items) {
  const auto after = std::ranges::lower_bound(items, t_ns, {}, &Timed::t_ns);
  if (after == items.end()) return {items.back(), items.back()};
  if (after == items.begin() || after->t_ns == t_ns) return {*after, *after};
  const Timed& before = *std::prev(after);
  return {before, *after,
          static_cast<double>(t_ns - before.t_ns) / static_cast<double>(after->t_ns - before.t_ns)};
}

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
  Rest rest{{{readings.front().t_ns}, all.gyro()}, all.end_ns};
  if (all.accel().norm() > 0) {
    const Vector3d up = all.accel().normalized();
    rest.start.accel_bias_mps2 = all.accel() - gravity_mps2 * up;
    rest.start.q_WB = sim::least_rotation(up, Vector3d::UnitZ());
  }
  return rest;
}

}  // namespace

SteadyMotion::SteadyMotion(double speed_mps, const std::optional<Vector3d>& mount_rpy_rad)
    : speed_mps_(speed_mps) {
  if (mount_rpy_rad) up_C_ = camera_mount(*mount_rpy_rad).row(2);
}

EgoMotion SteadyMotion::at(std::int64_t t_ns) {
  EgoMotion motion;
  if (last_ns_) {
    motion.dt_s = seconds(t_ns - *last_ns_);
    motion.v_C_mps = {0, 0, speed_mps_};
    motion.unseen_turn_rad = unseen_turn_rad(motion.dt_s);
  }
  last_ns_ = t_ns;
  return motion;
}

std::vector<MotionSource::Reading> SteadyMotion::other_readings() const {
  std::vector<Reading> all;
  all.push_back({speed_mps_ == 0 ? "the camera moves ahead: give its speed"
                                 : "the camera moves backwards: give the speed the other sign",
                 std::make_unique<SteadyMotion>(speed_mps_ == 0 ? 1 : -speed_mps_, std::nullopt)});
  return all;
}

void begin_at(std::int64_t t_ns, SensorReadings& readings) {
  const auto begin = [&](auto& samples) {
    std::erase_if(samples, [&](const auto& sample) { return sample.t_ns < t_ns; });
    for (auto& sample : samples) sample.t_ns -= t_ns;
  };
  begin(readings.imu);
  begin(readings.odometry);
  begin(readings.poses);
}

SensorMotion::SensorMotion(const scenario::Scenario& settings, const sim::Calibration& calibration,
                           SensorReadings readings)
    : settings_(settings),
      calibration_(calibration),
      needs_poses_(settings.ego_motion == scenario::EgoMotionSource::truth),
      R_SC_(calibration.T_BS.R.transpose() * calibration.T_BC.R),
      readings_(std::move(readings)),
      feed_(settings, calibration) {}

EgoMotion SensorMotion::at(std::int64_t t_ns) {
  sim::Observation observation;
  observation.t_ns = t_ns;
  const auto take = [&](const auto& all, std::size_t& next, auto& taken) {
    for (; next < all.size() && all[next].t_ns <= t_ns; ++next) taken.push_back(all[next]);
  };
  take(readings_.imu, imu_, observation.imu);
  take(readings_.odometry, odometry_, observation.odometry);
  while (pose_ < readings_.poses.size() && readings_.poses[pose_].t_ns < t_ns) ++pose_;
  const bool has_pose = pose_ < readings_.poses.size() && readings_.poses[pose_].t_ns == t_ns;
  if (has_pose) {
    observation.truth.now.T_WC = readings_.poses[pose_].T_WC;
  } else if (needs_poses_) {
    refuse({},
           "there is no pose of the camera at {} ns; give cam0/pose.csv a row for each picture, or "
           "leave --ego-motion truth out",
           t_ns);
  }
  const bench::EgoMotionFeed::Motions motions = feed_.next(observation);
  exact_ = has_pose && had_pose_ ? std::optional(motions.exact) : std::nullopt;
  had_pose_ = has_pose;
  return motions.told;
}

std::optional<Vector3d> SensorMotion::up_C() const {
  return R_SC_.transpose() * feed_.estimator().R_WS().row(2).transpose();
}

std::vector<MotionSource::Reading> SensorMotion::other_readings() const {
  SensorReadings reversed = readings_;
  for (sim::ImuSample& sample : reversed.imu) sample.accel_mps2 *= -1;
  sim::Calibration upside_down = calibration_, inverted = calibration_;
  const Eigen::Matrix3d R_over = Eigen::Vector3d(1, -1, -1).asDiagonal();
  upside_down.T_WB_start.R = R_over * calibration_.T_WB_start.R;
  upside_down.v_WB_start_mps = R_over * calibration_.v_WB_start_mps;
  inverted.T_BC = calibration_.T_BC.inverse();
  std::vector<Reading> all;
  all.push_back({"its accelerations have the other sign, as those of iOS: change it",
                 std::make_unique<SensorMotion>(settings_, upside_down, std::move(reversed))});
  all.push_back(
      {"the camera's pose on the IMU is inverted (T_cam_imu or T_imu_cam): give its inverse",
       std::make_unique<SensorMotion>(settings_, inverted, readings_)});
  return all;
}

CameraPoses poses_along(const std::vector<NavigationState>& states,
                        const std::vector<std::int64_t>& frames_ns, const sim::Pose& T_BC) {
  std::vector<NavigationState> all = states;
  for (const std::int64_t t_ns : frames_ns) {
    const auto [a, b, share] = around(t_ns, states);
    all.push_back(
        {t_ns, a.q_WB.slerp(share, b.q_WB), (1 - share) * a.v_WB_mps + share * b.v_WB_mps});
  }
  std::ranges::stable_sort(all, {}, &NavigationState::t_ns);
  CameraPoses poses;
  Vector3d p_WB_m = Vector3d::Zero();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) {
      const double dt_s = seconds(all[i].t_ns - all[i - 1].t_ns);
      if (dt_s <= 0) continue;
      p_WB_m += 0.5 * dt_s * (all[i - 1].v_WB_mps + all[i].v_WB_mps);
    }
    poses.push_back({all[i].t_ns, sim::Pose{all[i].q_WB.toRotationMatrix(), p_WB_m} * T_BC});
  }
  return poses;
}

std::vector<MotionSource::Reading> PosesMotion::other_readings() const {
  std::vector<Reading> all;
  if (!may_be_misread_) return all;
  const auto add = [&](const char* remedy, const auto& read) {
    CameraPoses poses = poses_;
    for (CameraPose& pose : poses) pose.T_WC = read(pose.T_WC);
    all.push_back({remedy, std::make_unique<PosesMotion>(std::move(poses), up_W_)});
  };
  const auto turned = [](const sim::Pose& T, double w, double x, double y, double z) {
    return sim::Pose{Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix(), T.p};
  };
  add("they are the world's poses in the camera: give their inverse",
      [](const sim::Pose& T) { return T.inverse(); });
  add("their quaternions have w first: give x, y, z, w, or a header", [&](const sim::Pose& T) {
    const Eigen::Quaterniond q(T.R);
    return turned(T, q.x(), q.y(), q.z(), q.w());
  });
  add("their quaternions have w last: give w, x, y, z, or a header", [&](const sim::Pose& T) {
    const Eigen::Quaterniond q(T.R);
    return turned(T, q.z(), q.w(), q.x(), q.y());
  });
  return all;
}

PosesMotion::PosesMotion(CameraPoses poses, const std::optional<Vector3d>& up_W,
                         bool may_be_misread)
    : poses_(std::move(poses)), up_W_(up_W), may_be_misread_(may_be_misread) {}

sim::Pose PosesMotion::pose_at(std::int64_t t_ns) const {
  const auto [a, b, share] = around(t_ns, poses_);
  if (share == 0) return a.T_WC;
  const Eigen::Quaterniond from(a.T_WC.R), to(b.T_WC.R);
  return {from.slerp(share, to).toRotationMatrix(), (1 - share) * a.T_WC.p + share * b.T_WC.p};
}

EgoMotion PosesMotion::at(std::int64_t t_ns) {
  const CameraPose now{t_ns, pose_at(t_ns)};
  EgoMotion motion;
  if (last_) {
    const double dt_s = seconds(now.t_ns - last_->t_ns);
    motion = bench::motion_between(last_->T_WC, now.T_WC, dt_s);
  }
  last_ = now;
  return motion;
}

std::optional<Vector3d> PosesMotion::up_C() const {
  if (!last_ || !up_W_) return std::nullopt;
  return last_->T_WC.R.transpose() * *up_W_;
}

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
    start.q_WB = sim::least_rotation(beginning.up_S_mps2, Vector3d::UnitZ()).normalized();
    if (is_at_rest) start.gyro_bias_radps = beginning.rate_S_radps;
  }
  start.v_WB_mps = speed_mps * (start.q_WB.toRotationMatrix() * R_BC.col(2));
  return start;
}

}  // namespace lcs::replay
