#include "tools/bench/ego_motion_feed.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lcs::bench {
namespace {

/// Zero odometry noise would leave the estimator's gain undefined.
constexpr double kLeastOdometryNoise_mps = 1e-3, kLeastYawNoise_radps = 1e-3;

Mounting mounting_of(const sim::Calibration& calibration) {
  return {.R_BC = calibration.T_BC.R,
          .p_BC_m = calibration.T_BC.p,
          .R_BS = calibration.T_BS.R,
          .p_BS_m = calibration.T_BS.p,
          .on_ground = calibration.on_ground};
}

EgoMotionNoise noise_of(const scenario::Scenario& scenario) {
  const scenario::ImuNoise& imu = scenario.imu.noise;
  return {.gyro_density = imu.gyroscope_noise_density,
          .gyro_walk = imu.gyroscope_random_walk,
          .accel_density = imu.accelerometer_noise_density,
          .accel_walk = imu.accelerometer_random_walk,
          .odometry_mps = std::max(scenario.odometry.noise_mps, kLeastOdometryNoise_mps),
          .odometry_radps = std::max(scenario.odometry.yaw_noise_radps, kLeastYawNoise_radps),
          .gyro_turn_on_bias =
              std::max(imu.gyroscope_turn_on_bias_radps, EgoMotionNoise{}.gyro_turn_on_bias),
          .accel_turn_on_bias =
              std::max(imu.accelerometer_turn_on_bias_mps2, EgoMotionNoise{}.accel_turn_on_bias)};
}

EgoMotionEstimator::Start start_of(const sim::Calibration& calibration) {
  return {.t_ns = 0,
          .R_WB = calibration.T_WB_start.R,
          .v_WB_mps = calibration.v_WB_start_mps,
          .gravity_mps2 = calibration.gravity_mps2};
}

}  // namespace

EgoMotion motion_between(const sim::Pose& T_WC_before, const sim::Pose& T_WC_now, double dt_s) {
  EgoMotion motion;
  motion.dt_s = dt_s;
  motion.R_cur_prev = T_WC_now.R.transpose() * T_WC_before.R;
  motion.v_C_mps = T_WC_now.R.transpose() * (T_WC_now.p - T_WC_before.p) / dt_s;
  const Eigen::AngleAxisd turned(motion.R_cur_prev.transpose());
  motion.w_C_radps = turned.angle() / dt_s * turned.axis();
  return motion;
}

EgoMotionFeed::EgoMotionFeed(const scenario::Scenario& scenario,
                             const sim::Calibration& calibration)
    : source_(scenario.ego_motion),
      estimator_(mounting_of(calibration), noise_of(scenario), start_of(calibration)),
      told_later_ns_(std::llround(1e9 * scenario.camera.told.time_offset_error_s)),
      on_ground_(calibration.on_ground),
      ground_W_m_(calibration.T_WB_start.p.z()) {}

EgoMotionFeed::Motions EgoMotionFeed::next(const sim::Observation& observation) {
  Motions motions;
  motions.exact = exact(observation);
  motions.told =
      source_ == scenario::EgoMotionSource::truth ? motions.exact : estimated(observation);
  return motions;
}

EgoMotion EgoMotionFeed::exact(const sim::Observation& observation) {
  const Frame now{observation.t_ns, observation.truth.now.T_WC};
  EgoMotion motion;
  if (last_) {
    motion =
        motion_between(last_->T_WC, now.T_WC, static_cast<double>(now.t_ns - last_->t_ns) * 1e-9);
  }
  last_ = now;
  const double height_m = now.T_WC.p.z() - ground_W_m_;
  if (on_ground_ && height_m > 0)
    motion.ground = Ground{.up_C = now.T_WC.R.row(2), .height_m = height_m};
  return motion;
}

EgoMotion EgoMotionFeed::estimated(const sim::Observation& observation) {
  auto odometry = observation.odometry.begin();
  const auto add_odometry_before = [&](std::int64_t t_ns) {
    for (; odometry != observation.odometry.end() && odometry->t_ns < t_ns; ++odometry) {
      estimator_.add_odometry(odometry->t_ns, odometry->velocity_mps, odometry->yaw_rate_radps);
    }
  };
  for (const sim::ImuSample& sample : observation.imu) {
    add_odometry_before(sample.t_ns);  // at equal times the IMU comes first
    estimator_.add_imu(sample.t_ns, sample.gyro_radps, sample.accel_mps2);
  }
  const std::int64_t told_ns = observation.t_ns + told_later_ns_;
  add_odometry_before(told_ns + 1);
  return estimator_.frame(told_ns);
}

}  // namespace lcs::bench
