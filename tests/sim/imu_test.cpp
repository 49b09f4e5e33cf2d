// The IMU against figures from physics, with ideal sensors: their noise has its own test.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/world/world.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using test::floor_with;
using test::scenario_in_mjcf;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr double kGravity = 9.81;

std::vector<ImuSample> read(World& world, std::int64_t until_ns) {
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  world.advance_to(until_ns, imu, odometry);
  return imu;
}

TEST(Imu, AtRestReadsGravityUpwards) {
  World world(scenario_in_mjcf(floor_with(""), 0, 1));
  EXPECT_EQ(world.gravity_mps2(), kGravity);
  for (const ImuSample& s : read(world, kSecond)) {
    EXPECT_NEAR((s.accel_mps2 - Vector3d(0, 0, kGravity)).norm(), 0, 1e-9);
    EXPECT_NEAR(s.gyro_radps.norm(), 0, 1e-12);
  }
}

TEST(Imu, OnWheelsAtRestReadsGravityUpwards) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  s.ego.drive = scenario::Drive::wheeled;
  World world(s);
  for (const ImuSample& sample : read(world, kSecond)) {
    // contacts are still settling by micrometres
    EXPECT_NEAR((sample.accel_mps2 - Vector3d(0, 0, kGravity)).norm(), 0, 0.01);
    EXPECT_NEAR(sample.gyro_radps.norm(), 0, 1e-3);
  }
}

TEST(Imu, FeelsTheGravityOfTheScene) {
  std::string moon = floor_with("");
  moon.insert(moon.find("<statistic"), "<option gravity=\"0 0 -1.62\"/>");
  World world(scenario_in_mjcf(moon, 0, 1));
  EXPECT_EQ(world.gravity_mps2(), 1.62);
  EXPECT_NEAR(read(world, 0).at(0).accel_mps2.z(), 1.62, 1e-9);
}

// A point at distance r from the axis of a turn at w is accelerated by w^2 r towards the axis.
TEST(Imu, OnALeverArmUnderConstantRotationReadsTheCentripetalAcceleration) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  constexpr double kRate = 1.5;
  s.ego.phases = {{.yaw_rate_radps = kRate}};
  World world(s);
  const Vector3d arm(0.3, -0.1, 0.2);
  double* site = world.model().m().site_pos + 3 * world.model().id(mjOBJ_SITE, "ego/imu");
  Eigen::Map<Vector3d>(site, 3) = arm;
  const Vector3d expected(-kRate * kRate * arm.x(), -kRate * kRate * arm.y(), kGravity);
  for (const ImuSample& sample : read(world, 2 * kSecond)) {
    if (sample.t_ns < kSecond / 10)
      continue;  // moved after the first forward pass; the base settles
    EXPECT_NEAR((sample.accel_mps2 - expected).norm(), 0, 1e-3 * kRate * kRate);
    EXPECT_NEAR((sample.gyro_radps - Vector3d(0, 0, kRate)).norm(), 0, 3e-4);
  }
}

// On a circle at v the acceleration is v w to the left.
TEST(Imu, OnACircleReadsSpeedTimesTurnRateToTheLeft) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 1);
  s.ego.phases[0].yaw_rate_radps = 0.4;
  World world(s);
  for (const ImuSample& sample : read(world, 2 * kSecond)) {
    if (sample.t_ns < kSecond / 10) continue;  // the base settles its lag of 4 ms
    // the lag turns the force by w tau = 1.6 mrad, and affects the gyro in full
    EXPECT_NEAR((sample.accel_mps2 - Vector3d(0, 0.2, kGravity)).norm(), 0, 2e-3);
  }
}

/// Expects that the readings of a drive, integrated by the mid attitude of each, lead from the true
/// attitude and velocity of S at 0 to those at the end. Rounding alone separates them.
void expect_exact(World& world, double rate_hz, double seconds) {
  read(world, 0);
  Eigen::Quaterniond R(world.T_WS().R);
  Vector3d v = world.v_WS_mps();
  std::int64_t before_ns = 0;
  const auto turn = [](const Vector3d& angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle.norm(), angle.stableNormalized()));
  };
  for (const ImuSample& s : read(world, event_time_ns(std::llround(seconds * rate_hz), rate_hz))) {
    const double dt = 1e-9 * static_cast<double>(s.t_ns - before_ns);
    before_ns = s.t_ns;
    v += (R * turn(0.5 * dt * s.gyro_radps) * s.accel_mps2 - Vector3d(0, 0, kGravity)) * dt;
    R = R * turn(dt * s.gyro_radps);
  }
  EXPECT_NEAR((v - world.v_WS_mps()).norm(), 0, 1e-9);
  EXPECT_NEAR(R.angularDistance(Eigen::Quaterniond(world.T_WS().R)), 0, 1e-7);
}

TEST(Imu, IntegratesToAttitudeAndVelocityAtAnyRate) {
  auto s = scenario_in_mjcf(floor_with(""), 0.2, 1);
  s.ego.phases = {{.speed_mps = 0.2, .acceleration_mps2 = 0.4, .yaw_rate_radps = 0.5},
                  {.at_s = 1, .speed_mps = 0.1, .direction_rad = pi / 2},
                  {.at_s = 1.5, .speed_mps = 0}};
  for (const double rate_hz : {50, 130, 200, 1000}) {
    s.imu.rate_hz = rate_hz;
    World world(s);
    expect_exact(world, rate_hz, 2);
  }
}

// Between two readings the contacts of a stiff wheel on bumps accelerate it to and fro: samples of
// the acceleration would miss most of that.
TEST(Imu, OnWheelsOverBumpsIntegratesToAttitudeAndVelocity) {
  auto s = scenario_in_mjcf(floor_with(""), 1, 1);
  s.ego.drive = scenario::Drive::wheeled;
  s.ground.emplace().roughness_m = 0.006;
  s.imu.rate_hz = 100;
  World world(s);
  expect_exact(world, 100, 3);
}

/// The rate and the specific force of an instant, by central differences of the exact motion, whose
/// error grows with the square of the step. A mean is that of half a period earlier.
TEST(Imu, ReadsTheInstantOfItsStampOrTheMeanBeforeIt) {
  auto s = test::scenario_in("lab", 0, 3);
  s.ego = {};
  s.ego.path = {{0, {0, 0, 0.6}, {0, 0, 0}},
                {0.3, {0.1, 0.02, 0.62}, {0.05, -0.06, 0.3}},
                {0.6, {0.3, 0.05, 0.6}, {-0.05, 0.06, 0.8}},
                {0.9, {0.5, 0.05, 0.6}, {0, 0, 0.9}}};
  s.imu.rate_hz = 500;
  constexpr std::int64_t kPeriod = kSecond / 500, kStep = kPeriod / 2;
  for (const auto& [reading, lag_ns] : {std::pair{scenario::ImuReading::sample, std::int64_t{0}},
                                        {scenario::ImuReading::mean, kPeriod / 2}}) {
    s.imu.reading = reading;
    World world(s);
    std::vector<ImuSample> imu = read(world, kSecond / 2);
    World stepped(s);
    const auto motion_at = [&](std::int64_t t_ns) {
      read(stepped, t_ns);
      return std::pair(stepped.T_WS(), stepped.v_WS_mps());
    };
    double most_gyro = 0, most_accel = 0, moved = 0;
    for (std::size_t i = 50; i < imu.size(); i += 20) {
      const std::int64_t t_ns = imu[i].t_ns - lag_ns;
      const auto [before, v_before] = motion_at(t_ns - kStep);
      const auto [now, v_now] = motion_at(t_ns);
      const auto [after, v_after] = motion_at(t_ns + kStep);
      const double span_s = 2e-9 * kStep;
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(before.R.transpose() * after.R));
      const Vector3d rate = turn.angle() / span_s * turn.axis();
      const Vector3d force =
          now.R.transpose() * ((v_after - v_before) / span_s + Vector3d(0, 0, kGravity));
      most_gyro = std::max(most_gyro, (imu[i].gyro_radps - rate).norm());
      most_accel = std::max(most_accel, (imu[i].accel_mps2 - force).norm());
      moved = std::max(moved, rate.norm());
    }
    EXPECT_GT(moved, 1);
    EXPECT_LT(most_gyro, 2e-4);  // half a period of some 10 rad/s^2 would be 1e-2
    EXPECT_LT(most_accel, 5e-3);
  }
}

TEST(Imu, ReadingsFallOnWholeMultiplesOfThePeriod) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 1);
  s.imu.rate_hz = 300;  // a period that is no decimal fraction of a second
  World world(s);
  const std::vector<ImuSample> imu = read(world, 10 * kSecond);
  ASSERT_EQ(imu.size(), 3001u);
  for (std::size_t i = 0; i < imu.size(); ++i) {
    EXPECT_EQ(imu[i].t_ns, std::llround(static_cast<double>(i) * 1e9 / 300));
  }
}

TEST(Imu, ReadingsAreTheSameHoweverManyFramesLieBetween) {
  const auto s = scenario_in_mjcf(floor_with(""), 0.5, 1);
  World often(s);
  World seldom(s);
  std::vector<ImuSample> imu;
  for (int k = 0; k <= 20; ++k) {
    for (const ImuSample& sample : read(often, k * kSecond / 20)) imu.push_back(sample);
  }
  const std::vector<ImuSample> expected = read(seldom, kSecond);
  ASSERT_EQ(imu.size(), expected.size());
  for (std::size_t i = 0; i < imu.size(); ++i) {
    EXPECT_EQ(imu[i].t_ns, expected[i].t_ns);
    EXPECT_EQ(imu[i].accel_mps2, expected[i].accel_mps2);
    EXPECT_EQ(imu[i].gyro_radps, expected[i].gyro_radps);
  }
}

}  // namespace
}  // namespace lcs::sim
