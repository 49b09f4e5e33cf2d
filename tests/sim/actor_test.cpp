#include "sim/world/actor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

constexpr double kExact = 1e-12;  // a few roundings of numbers of order 1
const PlanarPose kHome{{1.5, -2.0}, 0.7};

TEST(Trajectory, StillStaysWhereTheSceneHasTheBodyUnlessToldOtherwise) {
  const PlanarPose there = pose_on(scenario::Still{}, kHome, 12);
  EXPECT_EQ(there.position_m, kHome.position_m);
  EXPECT_EQ(there.heading_rad, kHome.heading_rad);

  const PlanarPose put =
      pose_on(scenario::Still{.position_m = Vector2d(3, 4), .heading_rad = pi / 2}, kHome, 12);
  EXPECT_EQ(put.position_m, Vector2d(3, 4));
  EXPECT_EQ(put.heading_rad, pi / 2);
}

TEST(Trajectory, LineCoversHalfTSquaredPlusVt) {
  const scenario::Line line{
      .from_m = Vector2d(1, 1), .heading_rad = pi / 6, .speed_mps = 0.5, .acceleration_mps2 = 0.2};
  const PlanarPose p = pose_on(line, kHome, 3);
  const double way = 0.5 * 3 + 0.2 * 9 / 2;
  EXPECT_NEAR((p.position_m - Vector2d(1 + way * std::cos(pi / 6), 1 + way * 0.5)).norm(), 0,
              kExact);
  EXPECT_EQ(p.heading_rad, pi / 6);
}

TEST(Trajectory, LineTakesFromTheSceneWhatItLeavesOpen) {
  const PlanarPose p =
      pose_on(scenario::Line{.from_m = {}, .heading_rad = {}, .speed_mps = 2}, kHome, 1);
  EXPECT_NEAR((p.position_m - kHome.position_m - 2 * Vector2d(std::cos(0.7), std::sin(0.7))).norm(),
              0, kExact);
}

TEST(Trajectory, LineThatBrakesParksAndDoesNotReverse) {
  const scenario::Line line{
      .from_m = Vector2d(0, 0), .heading_rad = 0, .speed_mps = 1, .acceleration_mps2 = -0.5};
  // v^2 / 2a = 1 m, reached after 2 s
  EXPECT_NEAR(pose_on(line, kHome, 2).position_m.x(), 1, kExact);
  EXPECT_NEAR(pose_on(line, kHome, 100).position_m.x(), 1, kExact);
  EXPECT_LT(pose_on(line, kHome, 1.9).position_m.x(), 1);
}

TEST(Trajectory, LineFromRestThatBrakesStays) {
  const scenario::Line line{.from_m = Vector2d(0, 0), .heading_rad = 0, .acceleration_mps2 = -1};
  EXPECT_EQ(pose_on(line, kHome, 5).position_m, Vector2d(0, 0));
}

const scenario::Waypoints kDogleg{{1, {0, 0}}, {3, {4, 0}}, {5, {4, 0}}, {6, {4, 3}}};

TEST(Trajectory, WaypointsAreReachedAtTheirTimesAndUniformInBetween) {
  EXPECT_EQ(pose_on(kDogleg, kHome, 1).position_m, Vector2d(0, 0));
  EXPECT_NEAR((pose_on(kDogleg, kHome, 1.5).position_m - Vector2d(1, 0)).norm(), 0, kExact);
  EXPECT_NEAR((pose_on(kDogleg, kHome, 3).position_m - Vector2d(4, 0)).norm(), 0, kExact);
  EXPECT_NEAR((pose_on(kDogleg, kHome, 5.5).position_m - Vector2d(4, 1.5)).norm(), 0, kExact);
}

TEST(Trajectory, WaypointsWaitBeforeTheFirstAndAfterTheLast) {
  EXPECT_EQ(pose_on(kDogleg, kHome, -3).position_m, Vector2d(0, 0));
  EXPECT_EQ(pose_on(kDogleg, kHome, 0.2).position_m, Vector2d(0, 0));
  EXPECT_EQ(pose_on(kDogleg, kHome, 60).position_m, Vector2d(4, 3));
}

TEST(Trajectory, WaypointsHeadTheWayTheyMoveAndKeepTheHeadingWhileTheyPause) {
  EXPECT_EQ(pose_on(kDogleg, kHome, 0).heading_rad, 0);
  EXPECT_EQ(pose_on(kDogleg, kHome, 2).heading_rad, 0);
  EXPECT_EQ(pose_on(kDogleg, kHome, 4).heading_rad, 0);
  EXPECT_NEAR(pose_on(kDogleg, kHome, 5.5).heading_rad, pi / 2, kExact);
  EXPECT_NEAR(pose_on(kDogleg, kHome, 60).heading_rad, pi / 2, kExact);

  const scenario::Waypoints pause_first{{0, {0, 0}}, {1, {0, 0}}, {2, {0, -1}}};
  EXPECT_NEAR(pose_on(pause_first, kHome, 0.5).heading_rad, -pi / 2, kExact);
}

TEST(Trajectory, WaypointsThatLeadNowhereKeepTheScenesHeading) {
  const scenario::Waypoints nowhere{{0, {1, 1}}, {1, {1, 1}}};
  EXPECT_EQ(pose_on(nowhere, kHome, 0.5).heading_rad, kHome.heading_rad);
}

TEST(Trajectory, CircleKeepsItsRadiusAndHeadsAlongTheTangent) {
  for (const double speed : {0.8, -0.8}) {
    const scenario::Circular circle{
        .centre_m = {1, 2}, .radius_m = 2, .start_angle_rad = 0.3, .speed_mps = speed};
    constexpr double kStep = 1e-6;
    for (const double t : {0.0, 1.0, 7.5}) {
      const PlanarPose p = pose_on(circle, kHome, t);
      EXPECT_NEAR((p.position_m - circle.centre_m).norm(), 2, kExact);
      const Vector2d v = (pose_on(circle, kHome, t + kStep).position_m - p.position_m) / kStep;
      // the difference quotient errs by half the centripetal acceleration times the step
      EXPECT_NEAR((v - 0.8 * Vector2d(std::cos(p.heading_rad), std::sin(p.heading_rad))).norm(), 0,
                  1e-6);
    }
    // ccw for a positive speed
    const double angle = 0.3 + speed / 2 * 1.0;
    EXPECT_NEAR((pose_on(circle, kHome, 1).position_m -
                 Vector2d(1 + 2 * std::cos(angle), 2 + 2 * std::sin(angle)))
                    .norm(),
                0, kExact);
  }
}

TEST(Trigger, FiresAtItsTimeWhereverItIsAskedAbout) {
  Trigger trigger({.at_s = 1.25, .ego_within_m = {}});
  EXPECT_LT(trigger.update(0, 1), 0);
  EXPECT_LT(trigger.update(1'249'999'999, 1), 0);
  EXPECT_NEAR(trigger.update(1'300'000'000, 1), 0.05, kExact);
  EXPECT_NEAR(trigger.update(2'000'000'000, 1), 0.75, kExact);
}

TEST(Trigger, WaitsForTheEgoToComeNear) {
  Trigger trigger({.at_s = 0, .ego_within_m = 3.0});
  EXPECT_LT(trigger.update(0, 5), 0);
  EXPECT_LT(trigger.update(1'000'000'000, 3.001), 0);
  EXPECT_EQ(trigger.update(2'000'000'000, 3.0), 0);
}

TEST(Trigger, NeedsAllOfItsConditionsAtOnce) {
  Trigger trigger({.at_s = 2, .ego_within_m = 3.0});
  EXPECT_LT(trigger.update(1'000'000'000, 1), 0) << "near, but too early";
  EXPECT_LT(trigger.update(2'500'000'000, 4), 0) << "late, but far";
  EXPECT_EQ(trigger.update(3'000'000'000, 1), 0);
}

TEST(Trigger, StaysFiredWhenTheEgoLeaves) {
  Trigger trigger({.at_s = 0, .ego_within_m = 3.0});
  EXPECT_EQ(trigger.update(1'000'000'000, 2), 0);
  EXPECT_NEAR(trigger.update(4'000'000'000, 50), 3, kExact);
}

}  // namespace
}  // namespace lcs::sim
