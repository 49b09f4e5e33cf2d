#include "tools/replay/motion_source.h"

#include <algorithm>

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

}  // namespace lcs::replay
