// A rover with waypoints and times: its true places at these times, and its path.
#include "sim/world/route.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/world/world.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using scenario::Waypoint;
using std::numbers::pi;
using test::floor_with;
using test::scenario_error;
using test::scenario_in_mjcf;

constexpr std::int64_t kSecond = 1'000'000'000;

scenario::Scenario along(std::vector<Waypoint> waypoints) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  s.ego.source = {"test.yaml", 3};
  s.ego.start_m = waypoints.front().position_m;
  const Vector2d first = waypoints[1].position_m - waypoints[0].position_m;
  s.ego.heading_rad = std::atan2(first.y(), first.x());
  s.ego.waypoints = std::move(waypoints);
  return s;
}

void advance(World& world, double t_s, std::vector<ImuSample>* imu = nullptr) {
  std::vector<ImuSample> ignored;
  std::vector<OdometrySample> odometry;
  world.advance_to(std::llround(t_s * 1e9), imu ? *imu : ignored, odometry);
}

double heading(const World& world) {
  return std::atan2(world.T_WB().R(1, 0), world.T_WB().R(0, 0));
}

double distance(const World& world, const Vector2d& place) {
  return (world.T_WB().p.head<2>() - place).norm();
}

// Right angles, a pause, a way back, and other speeds.
const std::vector<Waypoint> kTour = {{0, {-2, 1}},       {4, {0, 1}},      {7, {0, 2.5}},
                                     {9.5, {0, 2.5}},    {14.5, {2, 2.5}}, {20.5, {-1, 2.5}},
                                     {21.5, {-1.5, 2.5}}};

TEST(Route, TheRoverIsAtEachWaypointAtItsTime) {
  World world(along(kTour));
  for (const Waypoint& point : kTour) {
    advance(world, point.at_s);
    // a corner is rounded by |dv|^2 / 40 m/s^2: by 20 mm at the reversal from 0.4 to 0.5 m/s
    EXPECT_LT(distance(world, point.position_m), 0.023) << "at " << point.at_s << " s";
  }
  advance(world, 24);
  EXPECT_LT(distance(world, {-1.5, 2.5}), 3e-3) << "it stays at the last one";
  EXPECT_LT(world.v_WB_mps().norm(), 1e-6);
}

TEST(Route, IsStraightAndUniformBetweenBends) {
  World world(along(kTour));
  for (const double share : {0.25, 0.5, 0.75}) {
    advance(world, 4 * share);
    EXPECT_LT(distance(world, {-2 + 2 * share, 1}), 4e-3);
    EXPECT_NEAR((world.v_WB_mps().head<2>() - Vector2d(0.5, 0)).norm(), 0, 1e-3);
  }
}

TEST(Route, TheRoverLooksWhereItGoesAndTurnsNoFasterThanSaid) {
  World world(along(kTour));
  const std::vector<std::pair<double, double>> headings = {
      {0, 0}, {2, 0}, {5.5, pi / 2}, {7, pi / 2}, {9.5, 0}, {12, 0}, {17.5, pi}, {21, pi}};
  double last_rad = heading(world), last_s = 0;
  auto next = headings.begin();
  for (double t = 0; t <= 22; t += 0.02) {
    advance(world, t);
    const double turned = std::remainder(heading(world) - last_rad, 2 * pi);
    if (t > last_s) {
      EXPECT_LT(std::abs(turned) / (t - last_s), Route::kMaxYawRate_radps + 1e-3) << "at " << t;
    }
    last_rad = heading(world);
    last_s = t;
    if (next == headings.end() || t < next->first - 1e-9) continue;
    EXPECT_NEAR(std::remainder(heading(world) - next->second, 2 * pi), 0, 2e-3) << "at " << t;
    ++next;
  }
  EXPECT_EQ(next, headings.end());
}

TEST(Route, TheImuFeelsNoJump) {
  World world(along(kTour));
  std::vector<ImuSample> imu;
  advance(world, 23, &imu);
  for (std::size_t i = 1; i < imu.size(); ++i) {
    EXPECT_LT(imu[i].accel_mps2.head<2>().norm(), 5.5) << "at " << 1e-9 * double(imu[i].t_ns);
    EXPECT_LT(std::abs(imu[i].gyro_radps.z() - imu[i - 1].gyro_radps.z()), 0.06)
        << "more than 10 rad/s^2 at " << 1e-9 * double(imu[i].t_ns);
  }
}

// As from a planner or a recording: a circle of 1 m radius, ten waypoints per second.
TEST(Route, ManyNearWaypointsAreACurve) {
  std::vector<Waypoint> circle;
  for (int k = 0; k <= 120; ++k) {
    const double angle = 2 * pi * k / 120;
    circle.push_back({0.1 * k, {std::sin(angle), 1 - std::cos(angle)}});
  }
  World world(along(circle));
  for (int k = 0; k < 120; ++k) {
    advance(world, 0.1 * k);
    EXPECT_LT(distance(world, circle[static_cast<std::size_t>(k)].position_m), 5e-3) << k;
    EXPECT_LT(std::abs(std::remainder(heading(world) - 2 * pi * k / 120, 2 * pi)), 0.03) << k;
  }
}

TEST(Route, BeforeTheFirstWaypointTheRoverStandsThere) {
  World world(along({{1, {2, 0}}, {3, {2, 2}}}));
  advance(world, 0.85);
  EXPECT_EQ(distance(world, {2, 0}), 0);
  EXPECT_NEAR(heading(world), pi / 2, 1e-12);
  advance(world, 2);
  EXPECT_LT(distance(world, {2, 1}), 0.01);
}

TEST(Route, ImpossibleMotionIsRefusedAtItsWaypoint) {
  const auto refusal = [](const std::vector<Waypoint>& waypoints) {
    return scenario_error([&] { World world(along(waypoints)); });
  };
  EXPECT_EQ(refusal({{0, {0, 0}}, {1, {200, 0}}}),
            "test.yaml:3: at ego.waypoints.0 the rover would have to drive at 200 m/s (at most "
            "100); give it more time");
  EXPECT_NE(refusal({{0, {0, 0}}, {1, {1, 0}}, {1.001, {1.02, 0}}, {2, {2, 0}}})
                .find("at ego.waypoints.1 the rover would have to change its velocity by 19 m/s "
                      "within 0.001 s"),
            std::string::npos);
  EXPECT_NE(refusal({{0, {0, 0}}, {1, {.01, 0}}, {1.02, {.0099, 0}}, {2, {0, 0}}})
                .find("turn by 180 deg within 0.02 s"),
            std::string::npos);
}

}  // namespace
}  // namespace lcs::sim
