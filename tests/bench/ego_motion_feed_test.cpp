#include "tools/bench/ego_motion_feed.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace lcs::bench {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

/// The camera looks along the rover's x: its z is forward, its x right, its y down.
sim::Pose camera_mount() {
  sim::Pose T_BC;
  T_BC.R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T_BC.p = {0.2, 0, 0.45};
  return T_BC;
}

/// A rover that drives in a circle: all sensor readings are known in closed form.
struct CircularDrive {
  double speed_mps = 0.5;
  double yaw_rate_radps = 0.3;

  sim::Pose T_WB(double t) const {
    const double radius = speed_mps / yaw_rate_radps, yaw = yaw_rate_radps * t;
    return {AngleAxisd(yaw, Vector3d::UnitZ()).matrix(),
            {radius * std::sin(yaw), radius * (1 - std::cos(yaw)), 0}};
  }
  /// At the rover's origin: centripetal acceleration to its left, and gravity.
  sim::ImuSample imu(std::int64_t t_ns) const {
    return {t_ns, {0, 0, yaw_rate_radps}, {0, speed_mps * yaw_rate_radps, 9.81}};
  }
  sim::Calibration calibration() const {
    sim::Calibration calibration;
    calibration.T_BC = camera_mount();
    calibration.T_WB_start = T_WB(0);
    calibration.v_WB_start_mps = {speed_mps, 0, 0};
    calibration.on_ground = true;
    return calibration;
  }
  /// Frame k of a camera at 10 frames/s with an IMU at 200 Hz.
  sim::Observation observation(int k) const {
    sim::Observation observation;
    observation.index = k;
    observation.t_ns = k * std::int64_t{100'000'000};
    for (int i = k == 0 ? 0 : 20 * (k - 1) + 1; i <= 20 * k; ++i) {
      observation.imu.push_back(imu(i * std::int64_t{5'000'000}));
    }
    observation.truth.now.T_WC = T_WB(0.1 * k) * camera_mount();
    return observation;
  }
};

scenario::Scenario with_source(scenario::EgoMotionSource source) {
  scenario::Scenario scenario;
  scenario.ego_motion = source;
  return scenario;
}

TEST(MotionBetween, MovesAFixedPointFromOneCameraToTheNext) {
  const sim::Pose before{AngleAxisd(0.3, Vector3d(1, 2, 3).normalized()).matrix(), {1, 2, 3}};
  const sim::Pose now{AngleAxisd(0.5, Vector3d(3, 1, 2).normalized()).matrix(), {1.2, 1.9, 3.4}};
  const double dt = 0.25;
  const EgoMotion motion = motion_between(before, now, dt);
  const Vector3d x_W(5, -2, 7);
  const Vector3d expected = now.inverse() * x_W;
  const Vector3d moved = motion.R_cur_prev * (before.inverse() * x_W) - dt * motion.v_C_mps;
  EXPECT_LT((moved - expected).norm(), 1e-12);
}

TEST(MotionBetween, TheRotationIsTheExponentialOfTheBodyRate) {
  const Vector3d rate(0.2, -0.4, 0.1);  // rad/s, in the camera frame
  const double dt = 0.5;
  const sim::Pose before{AngleAxisd(0.7, Vector3d(1, -1, 2).normalized()).matrix(), {}};
  const sim::Pose now{before.R * AngleAxisd(rate.norm() * dt, rate.normalized()).matrix(), {}};
  EXPECT_LT((motion_between(before, now, dt).w_C_radps - rate).norm(), 1e-12);
}

TEST(EgoMotionFeed, TheFirstFrameHasNoMotion) {
  const CircularDrive drive;
  for (const auto source : {scenario::EgoMotionSource::imu, scenario::EgoMotionSource::truth}) {
    EgoMotionFeed feed(with_source(source), drive.calibration());
    const EgoMotionFeed::Motions motions = feed.next(drive.observation(0));
    EXPECT_EQ(motions.told.dt_s, 0);
    EXPECT_EQ(motions.exact.dt_s, 0);
    EXPECT_TRUE(motions.told.R_cur_prev.isIdentity());
  }
}

TEST(EgoMotionFeed, AnIdealImuTellsTheMotionThatThePosesHad) {
  // On a circle, trapezoids over 5 ms are exact to far below a micrometre per frame.
  const CircularDrive drive;
  EgoMotionFeed feed(with_source(scenario::EgoMotionSource::imu), drive.calibration());
  feed.next(drive.observation(0));
  for (int k = 1; k <= 50; ++k) {
    const EgoMotionFeed::Motions motions = feed.next(drive.observation(k));
    EXPECT_DOUBLE_EQ(motions.told.dt_s, 0.1);
    EXPECT_LT((motions.told.R_cur_prev - motions.exact.R_cur_prev).norm(), 1e-9) << k;
    EXPECT_LT((motions.told.v_C_mps - motions.exact.v_C_mps).norm(), 1e-5) << k;
    EXPECT_LT((motions.told.w_C_radps - motions.exact.w_C_radps).norm(), 1e-8) << k;
    EXPECT_NEAR(motions.told.v_C_mps.z(), 0.5, 0.01) << "forwards";
    ASSERT_TRUE(motions.told.ground && motions.exact.ground);
    EXPECT_LT((motions.told.ground->up_C - motions.exact.ground->up_C).norm(), 1e-9) << k;
    EXPECT_NEAR(motions.told.ground->height_m, 0.45, 1e-9);
    EXPECT_NEAR(motions.exact.ground->height_m, 0.45, 1e-9);
  }
}

TEST(EgoMotionFeed, MotionNotSaidToBeOnTheGroundHasNoGround) {
  const CircularDrive drive;
  sim::Calibration calibration = drive.calibration();
  calibration.on_ground = false;  // a drone, or an IMU without a vehicle
  EgoMotionFeed feed(with_source(scenario::EgoMotionSource::imu), calibration);
  const EgoMotionFeed::Motions motions = feed.next(drive.observation(0));
  EXPECT_FALSE(motions.told.ground);
  EXPECT_FALSE(motions.exact.ground);
}

TEST(EgoMotionFeed, TheTruthIsToldOnlyWhereTheScenarioSaysSo) {
  const CircularDrive drive;
  const auto told = [&](scenario::EgoMotionSource source) {
    EgoMotionFeed feed(with_source(source), drive.calibration());
    feed.next(drive.observation(0));
    sim::Observation observation = drive.observation(1);
    for (sim::ImuSample& sample : observation.imu) sample.gyro_radps.z() += 0.1;  // a bad gyro
    return feed.next(observation);
  };
  const auto by_imu = told(scenario::EgoMotionSource::imu);
  EXPECT_NEAR(by_imu.told.w_C_radps.norm(), 0.4, 0.01);
  EXPECT_NEAR(by_imu.exact.w_C_radps.norm(), 0.3, 1e-9);
  const auto by_truth = told(scenario::EgoMotionSource::truth);
  EXPECT_EQ(by_truth.told.w_C_radps, by_truth.exact.w_C_radps);
}

TEST(EgoMotionFeed, OdometryHoldsTheDriftOfABiasedAccelerometer) {
  const CircularDrive drive;
  const auto error_after_5s = [&](bool odometry) {
    scenario::Scenario scenario = with_source(scenario::EgoMotionSource::imu);
    scenario.imu.noise = {1.7e-4, 1.9e-5, 2e-3, 3e-3};
    EgoMotionFeed feed(scenario, drive.calibration());
    double error = 0;
    for (int k = 0; k <= 50; ++k) {
      sim::Observation observation = drive.observation(k);
      for (sim::ImuSample& sample : observation.imu) sample.accel_mps2.x() += 0.05;
      if (odometry) {
        for (const sim::ImuSample& sample : observation.imu) {
          observation.odometry.push_back({sample.t_ns, {drive.speed_mps, 0, 0}});
        }
      }
      const EgoMotionFeed::Motions motions = feed.next(observation);
      error = (motions.told.v_C_mps - motions.exact.v_C_mps).norm();
    }
    return error;
  };
  EXPECT_GT(error_after_5s(false), 0.15);
  EXPECT_LT(error_after_5s(true), 0.02);
}

/// Drives straight on, brakes from 1 s to 1.6 s, and goes on slowly.
struct BrakingDrive {
  static double speed_mps(double t) { return 0.5 - 0.5 * std::clamp(t - 1.0, 0.0, 0.6); }
  static double position_m(double t) {
    const double braked = std::clamp(t - 1.0, 0.0, 0.6);
    return 0.5 * t - 0.25 * braked * braked - 0.3 * std::max(0.0, t - 1.6);
  }
};

/// Largest error of the estimated velocity, m/s, when the IMU is silent from 0.9 s to 1.7 s.
double error_through_a_gap(bool odometry) {
  CircularDrive at_rest;
  sim::Calibration calibration = at_rest.calibration();
  scenario::Scenario scenario = with_source(scenario::EgoMotionSource::imu);
  scenario.imu.noise = {1.7e-4, 1.9e-5, 2e-3, 3e-3};
  scenario.odometry.noise_mps = 0.01;
  EgoMotionFeed feed(scenario, calibration);
  double worst = 0;
  for (int k = 0; k <= 30; ++k) {
    sim::Observation observation;
    observation.index = k;
    observation.t_ns = k * std::int64_t{100'000'000};
    for (int i = k == 0 ? 0 : 20 * (k - 1) + 1; i <= 20 * k; ++i) {
      const double t = 0.005 * i;
      const std::int64_t t_ns = i * std::int64_t{5'000'000};
      const double acceleration = t > 1.0 && t <= 1.6 ? -0.5 : 0;
      if (t < 0.9 || t >= 1.7)
        observation.imu.push_back({t_ns, {0, 0, 0}, {acceleration, 0, 9.81}});
      if (odometry && i % 4 == 0) {
        observation.odometry.push_back({t_ns, {BrakingDrive::speed_mps(t), 0, 0}});
      }
    }
    observation.truth.now.T_WC = {camera_mount().R, {BrakingDrive::position_m(0.1 * k), 0, 0}};
    const EgoMotionFeed::Motions motions = feed.next(observation);
    EXPECT_TRUE(motions.told.v_C_mps.allFinite());
    worst = std::max(worst, (motions.told.v_C_mps - motions.exact.v_C_mps).norm());
  }
  return worst;
}

TEST(EgoMotionFeed, WhileTheImuIsSilentItsLastReadingIsHeld) {
  // On a circle, rate and force are constant in the rover's frame, so holding them is exact.
  const CircularDrive drive;
  EgoMotionFeed feed(with_source(scenario::EgoMotionSource::imu), drive.calibration());
  for (int k = 0; k <= 30; ++k) {
    sim::Observation observation = drive.observation(k);
    if (k > 10 && k <= 20) observation.imu.clear();
    const EgoMotionFeed::Motions motions = feed.next(observation);
    EXPECT_LT((motions.told.R_cur_prev - motions.exact.R_cur_prev).norm(), 1e-9) << k;
    // whole frames are integrated in one step, whose error is of third order in 0.03 rad
    EXPECT_LT((motions.told.v_C_mps - motions.exact.v_C_mps).norm(), 1e-3) << k;
  }
}

TEST(EgoMotionFeed, OdometryTellsOfTheBrakingThatASilentImuDoesNotSee) {
  EXPECT_NEAR(error_through_a_gap(false), 0.3, 0.02);  // the whole change of speed
  EXPECT_LT(error_through_a_gap(true), 0.03);          // a tenth of it
}

}  // namespace
}  // namespace lcs::bench
