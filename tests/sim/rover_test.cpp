#include "sim/world/rover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/world/world.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;
using test::floor_with;
using test::scenario_in_mjcf;

constexpr std::int64_t kSecond = 1'000'000'000;

constexpr scenario::Odometry kExactWheels{
    .enabled = true, .noise_mps = 0, .yaw_noise_radps = 0, .scale_error = 0};

void advance(World& world, std::int64_t t_ns) {
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  world.advance_to(t_ns, imu, odometry);
}

TEST(CommandedVelocity, FollowsThePhaseThatBeganLast) {
  const std::vector<scenario::EgoPhase> phases = {
      {.at_s = 0, .speed_mps = 1, .acceleration_mps2 = -0.5},
      {.at_s = 0.7, .speed_mps = 0.4, .direction_rad = pi / 2, .yaw_rate_radps = 0.1}};
  EXPECT_EQ(commanded_velocity(phases, 0).linear_mps, Vector2d(1, 0));
  EXPECT_NEAR(commanded_velocity(phases, kSecond / 2).linear_mps.x(), 0.75, 1e-12);
  // a phase begins at its time to the nanosecond, despite rounding in seconds
  EXPECT_EQ(commanded_velocity(phases, 699'999'999).yaw_rate_radps, 0);
  EXPECT_EQ(commanded_velocity(phases, 700'000'000).yaw_rate_radps, 0.1);
  EXPECT_NEAR(commanded_velocity(phases, kSecond).linear_mps.y(), 0.4, 1e-12);
}

TEST(CommandedVelocity, ASpeedThatReachesZeroStaysZero) {
  const std::vector<scenario::EgoPhase> phases = {{.speed_mps = 1, .acceleration_mps2 = -0.5}};
  EXPECT_EQ(commanded_velocity(phases, 5 * kSecond).linear_mps, Vector2d(0, 0));
}

TEST(SmoothCommand, SpreadsAJumpOverTheTimeItsLimitTakes) {
  SmoothCommand command({{.speed_mps = 0.5}, {.at_s = 1, .speed_mps = 0, .yaw_rate_radps = 0.2}});
  EXPECT_EQ(command.at(0).linear_mps.x(), 0.5) << "already moving at the start";
  EXPECT_EQ(command.at(kSecond - 1).linear_mps.x(), 0.5);
  // 0.5 m/s at 5 m/s^2 takes 100 ms
  EXPECT_NEAR(command.at(kSecond - 1 + 40'000'000).linear_mps.x(), 0.3, 1e-12);
  EXPECT_EQ(command.at(kSecond + 100'000'001).linear_mps.x(), 0);
  EXPECT_EQ(command.at(kSecond + 100'000'001).yaw_rate_radps, 0.2);
}

TEST(SmoothCommand, GrantsAnAccelerationThatIsAskedFor) {
  SmoothCommand command({{.speed_mps = 0, .acceleration_mps2 = 20}});
  command.at(0);
  EXPECT_NEAR(command.at(kSecond / 10).linear_mps.x(), 2, 1e-12);
}

TEST(HolonomicRover, StartsWhereItIsToldAlreadyMoving) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 1);
  s.ego.start_m = {1, -2};
  s.ego.heading_rad = 0.6;
  World world(s);
  EXPECT_NEAR((world.T_WB().p - Vector3d(1, -2, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(std::atan2(world.T_WB().R(1, 0), world.T_WB().R(0, 0)), 0.6, 1e-12);
  EXPECT_NEAR((world.v_WB_mps() - 0.5 * Vector3d(std::cos(0.6), std::sin(0.6), 0)).norm(), 0,
              1e-12);
}

// A measurement of the base's gains gave 0.9 mm/s and 0.24 mrad/s; a first-order lag of 4 ms
// behind a velocity that turns at 0.3 rad/s accounts for v w tau = 0.6 mm/s.
TEST(HolonomicRover, FollowsItsCommandAlongASidewaysTurn) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 1);
  s.ego.phases = {{.speed_mps = 0.5,
                   .acceleration_mps2 = 0.05,
                   .direction_rad = pi / 3,
                   .yaw_rate_radps = 0.3}};
  World world(s);
  for (int k = 1; k <= 40; ++k) {
    advance(world, k * kSecond / 10);
    const PlanarVelocity wanted = commanded_velocity(s.ego.phases, k * kSecond / 10);
    const Vector3d v_B = world.T_WB().R.transpose() * world.v_WB_mps();
    EXPECT_NEAR((v_B.head<2>() - wanted.linear_mps).norm(), 0, 1e-3) << "at " << k / 10.0 << " s";
    EXPECT_EQ(v_B.z(), 0);
    const double yaw_rate =
        (world.T_WB().R * Vector3d::UnitZ()).dot(world.snapshot().T_WC.R * world.w_C_radps());
    EXPECT_NEAR(yaw_rate, 0.3, 3e-4);
  }
}

TEST(HolonomicRover, OdometryIsTheVelocityOfBInB) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 1);
  s.ego.heading_rad = 1.0;
  s.ego.phases = {{.speed_mps = 0.5, .direction_rad = pi / 2, .yaw_rate_radps = 0.2}};
  s.odometry = kExactWheels;
  World world(s);
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  world.advance_to(2 * kSecond, imu, odometry);
  ASSERT_EQ(odometry.size(), 101u);
  EXPECT_EQ(odometry.back().t_ns, 2 * kSecond);
  EXPECT_NEAR((odometry.back().velocity_mps - world.T_WB().R.transpose() * world.v_WB_mps()).norm(),
              0, 1e-9);
  EXPECT_NEAR((odometry.back().velocity_mps - Vector3d(0, 0.5, 0)).norm(), 0, 1e-3);
  EXPECT_NEAR(odometry.back().yaw_rate_radps.value(), 0.2, 1e-3);
}

struct WheeledRun {
  double speed_mps, yaw_rate_radps;
  Vector3d odometry_mps;
  double odometry_radps;
};

/// Mean over the last two of four seconds.
WheeledRun drive(double speed_mps, double direction_rad, double yaw_rate_radps) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  s.ego.drive = scenario::Drive::wheeled;
  s.ego.phases = {
      {.speed_mps = speed_mps, .direction_rad = direction_rad, .yaw_rate_radps = yaw_rate_radps}};
  s.odometry = kExactWheels;
  World world(s);
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  WheeledRun run{0, 0, Vector3d::Zero(), 0};
  constexpr int kSamples = 100;
  for (int k = 1; k <= 2 * kSamples; ++k) {
    world.advance_to(k * kSecond / 50, imu, odometry);
    if (k <= kSamples) continue;
    const Vector3d v_B = world.T_WB().R.transpose() * world.v_WB_mps();
    run.speed_mps += v_B.x() / kSamples;
    run.yaw_rate_radps += (world.snapshot().T_WC.R * world.w_C_radps()).z() / kSamples;
    run.odometry_mps += odometry.back().velocity_mps / kSamples;
    run.odometry_radps += odometry.back().yaw_rate_radps.value() / kSamples;
  }
  return run;
}

TEST(WheeledRover, ReachesNineteenTwentiethsOfTheIdealSpeed) {
  for (const double speed : {0.1, 0.5, 1.0}) {
    const WheeledRun run = drive(speed, 0, 0);
    EXPECT_NEAR(run.speed_mps, speed, 0.05 * speed);
    EXPECT_NEAR(run.yaw_rate_radps, 0, 1e-3);
    EXPECT_NEAR(run.odometry_mps.x(), run.speed_mps, 0.02 * speed) << "wheels on flat ground";
  }
}

TEST(WheeledRover, ReachesNineteenTwentiethsOfTheIdealTurnRate) {
  for (const double rate : {0.2, -0.5, 1.0}) {
    const WheeledRun run = drive(0.3, 0, rate);
    EXPECT_NEAR(run.yaw_rate_radps, rate, 0.05 * std::abs(rate));
    EXPECT_NEAR(run.odometry_radps, run.yaw_rate_radps, 0.02 * std::abs(rate)) << "by its wheels";
    EXPECT_NEAR(run.speed_mps, 0.3, 0.05 * 0.3);
  }
}

TEST(WheeledRover, DrivesBackwards) {
  EXPECT_NEAR(drive(0.4, pi, 0).speed_mps, -0.4, 0.02);
}

TEST(WheeledRover, StartsSettledAndRolling) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 1);
  s.ego.drive = scenario::Drive::wheeled;
  s.ego.start_m = {1, 2};
  s.ego.heading_rad = -0.8;
  World world(s);
  const Pose start = world.T_WB();
  // soft contacts yield by less than a millimetre
  EXPECT_NEAR((start.p - Vector3d(1, 2, 0)).norm(), 0, 1e-3);
  EXPECT_NEAR(std::atan2(start.R(1, 0), start.R(0, 0)), -0.8, 1e-6);
  EXPECT_NEAR((start.R.transpose() * world.v_WB_mps()).x(), 0.5, 1e-9);
  advance(world, kSecond / 10);
  const Vector3d way = start.R.transpose() * (world.T_WB().p - start.p);
  EXPECT_NEAR(way.x(), 0.05, 0.0025) << "no start from rest";
  EXPECT_NEAR(way.z(), 0, 1e-3) << "no drop";
}

TEST(WheeledRover, StandsOnTheGroundThatItFinds) {
  auto s = scenario_in_mjcf(floor_with(R"(<geom type="box" pos="0 0 .1" size="3 3 .1"/>
                    <geom name="roof" type="box" pos="0 0 2.5" size="3 3 .1"/>)"),
                            0, 1);
  s.ego.drive = scenario::Drive::wheeled;
  EXPECT_NEAR(World(s).T_WB().p.z(), 0.2, 1e-3);
}

TEST(WheeledRover, DrivesOnTheFloorsOfTheProjectsScenes) {
  for (const char* scene : {"lab", "street"}) {
    auto s = test::scenario_in(scene, 0.5, 1);
    s.ego.drive = scenario::Drive::wheeled;
    World world(s);
    advance(world, kSecond);
    EXPECT_NEAR((world.T_WB().p - Vector3d(-3.5, 0, 0)).norm(), 0, 0.01) << scene;
  }
}

// A scene's defaults must not change the rover's mass, joints and contacts.
TEST(Rovers, DriveAlikeWhateverTheDefaultsOfTheSceneAre) {
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<statistic"),
              "<compiler inertiafromgeom='true' settotalmass='1'/><default><geom contype='0' "
              "conaffinity='0' density='1'/><joint damping='30' armature='9'/><velocity kv='0.1' "
              "ctrllimited='true' ctrlrange='-.1 .1'/></default>");
  mjcf.insert(mjcf.find("rgba=\".5"), "contype='1' conaffinity='1' ");
  for (const auto drive : {scenario::Drive::holonomic, scenario::Drive::wheeled}) {
    auto plain = scenario_in_mjcf(floor_with(""), 0.5, 1);
    plain.ego.drive = drive;
    World expected(plain);
    advance(expected, kSecond);
    auto odd = scenario_in_mjcf(mjcf, 0.5, 1);
    odd.ego.drive = drive;
    World world(odd);
    advance(world, kSecond);
    EXPECT_NEAR((world.T_WB().p - expected.T_WB().p).norm(), 0, 1e-6);
    EXPECT_NEAR(world.T_WB().p.x(), 0.5, 0.005);
  }
}

TEST(WheeledRover, RefusesToDriveSideways) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 1);
  s.ego.drive = scenario::Drive::wheeled;
  s.ego.phases[0].direction_rad = pi / 2;
  const std::string message = test::scenario_error([&] { World world(s); });
  EXPECT_NE(message.find("sideways"), std::string::npos) << message;
  EXPECT_NE(message.find("90 deg"), std::string::npos) << message;
}

}  // namespace
}  // namespace lcs::sim
