// Walkers: feet that do not slide, and limbs each with its own true motion.
#include "sim/scene/gait.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "sim/observer.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using scenario::Shape;

constexpr double kLeg_m = 0.82, kAnkle_m = 0.08;  // of walker.xml
constexpr double kStride_m = Gait::kStride * kLeg_m;

scenario::Scenario walking(const scenario::Trajectory& trajectory) {
  scenario::Scenario s = test::scenario_in_mjcf(test::floor_with(""), 0, 1);
  s.actors = {test::line_actor("ann", Shape::walker, {3, 0}, 0, 1)};
  s.actors[0].trajectory = trajectory;
  return s;
}

/// A world with one walker, whose bodies are asked for at increasing times.
class Walk {
 public:
  explicit Walk(const scenario::Scenario& s) : world_(s) {}

  void reach(double t_s) { world_.advance_to(std::llround(1e9 * t_s), imu_, odometry_); }
  Pose body(const std::string& name) const {
    return world_.model().body_pose(world_.model().id(mjOBJ_BODY, "ann" + name));
  }
  const World& world() const { return world_; }

 private:
  World world_;
  std::vector<ImuSample> imu_;
  std::vector<OdometrySample> odometry_;
};

TEST(Walker, PlantsEachFootWithoutSlidingWhateverItsSpeed) {
  Walk walk(walking(scenario::Line{
      .from_m = Vector2d(2, 1), .heading_rad = 0.6, .speed_mps = 0.4, .acceleration_mps2 = 0.5}));
  constexpr double kStep_s = 0.005;
  constexpr int kSteps = 600;  // 3.45 m
  for (const std::string side : {"/left_", "/right_"}) {
    Walk again(walking(scenario::Line{
        .from_m = Vector2d(2, 1), .heading_rad = 0.6, .speed_mps = 0.4, .acceleration_mps2 = 0.5}));
    std::vector<Vector2d> places;  // where the foot was planted
    Vector3d last(0, 0, 1);
    double planted_m = 0, walked_m = 0;
    for (int i = 0; i < kSteps; ++i) {
      again.reach(kStep_s * i);
      const Pose foot = again.body(side + "foot");
      ASSERT_GT(foot.p.z(), kAnkle_m - 1e-9);
      EXPECT_NEAR(foot.R(2, 2), 1, 1e-12) << "the foot is level";
      const double way_m = kStep_s * (0.4 + 0.5 * kStep_s * i);
      walked_m += way_m;
      const bool is_planted = foot.p.z() < kAnkle_m + 1e-9;
      if (is_planted) planted_m += way_m;
      if (is_planted && last.z() < kAnkle_m + 1e-9) {
        EXPECT_LT((foot.p - last).norm() / kStep_s, 1e-9) << "m/s, at " << kStep_s * i << " s";
      } else if (is_planted) {
        places.emplace_back(foot.p.head<2>());
      }
      last = foot.p;
    }
    EXPECT_NEAR(planted_m / walked_m, Gait::kStance, 0.08);  // not a whole number of strides
    ASSERT_GE(places.size(), 3u);
    for (std::size_t i = 2; i < places.size(); ++i) {  // the first may be in the middle
      EXPECT_NEAR((places[i] - places[i - 1]).norm(), kStride_m, 1e-9);
    }
  }
}

TEST(Walker, BendsItsJointsAsAHumanDoesAndKeepsItsLimbsTogether) {
  Walk walk(walking(scenario::Line{.from_m = Vector2d(2, 1), .heading_rad = 0, .speed_mps = 1.2}));
  double least_knee = 10, most_knee = 0, most_hip = -10, least_hip = 10;
  for (int i = 0; i < 200; ++i) {
    walk.reach(0.01 * i);
    const Pose trunk = walk.body("/trunk");
    const auto lean = [&](const std::string& name) {  // of a hanging limb, positive ahead
      const Vector3d down = -walk.body(name).R.col(2);
      return std::atan2(down.x(), -down.z());
    };
    EXPECT_NEAR(trunk.p.x(), 2 + 1.2 * 0.01 * i, 1e-9);
    EXPECT_LT(std::abs(trunk.p.z() - 0.9 + 0.07 * kLeg_m), 0.04 * kLeg_m + 1e-9);
    for (const std::string side : {"/left_", "/right_"}) {
      const double hip = lean(side + "thigh"), knee = hip - lean(side + "shank");
      least_knee = std::min(least_knee, knee);
      most_knee = std::max(most_knee, knee);
      least_hip = std::min(least_hip, hip);
      most_hip = std::max(most_hip, hip);
      const Pose foot = walk.body(side + "foot"), shank = walk.body(side + "shank");
      EXPECT_NEAR((foot.p - shank.p).norm(), 0.41, 1e-9);
      // the ankle is where the cycloid has it, so that the leg is never too short
      const Vector3d to_hip = walk.body(side + "thigh").p - foot.p;
      EXPECT_LT(to_hip.norm(), kLeg_m);
    }
  }
  // human gait analysis: knee 0 to 65 deg, hip 10 deg to the back and 35 deg ahead, without a
  // crouch
  EXPECT_GE(least_knee, 0);
  EXPECT_LT(most_knee, 90 * test::kDegree);
  EXPECT_GT(most_knee, 45 * test::kDegree);
  EXPECT_GT(least_hip, -25 * test::kDegree);
  EXPECT_LT(most_hip, 55 * test::kDegree);
}

TEST(Walker, SlidesInABendByLessThanTheStatedShareOfItsSpeed) {
  constexpr double kRadius_m = 2, kSpeed_mps = 1, kStep_s = 0.002;
  Walk walk(walking(scenario::Circular{
      .centre_m = Vector2d(3, 0), .radius_m = kRadius_m, .speed_mps = kSpeed_mps}));
  double fastest_mps = 0;
  std::map<std::string, Vector3d> last;
  for (int i = 0; i < 1000; ++i) {
    walk.reach(kStep_s * i);
    for (const std::string side : {"/left_", "/right_"}) {
      const Vector3d p = walk.body(side + "foot").p;
      const bool stays = last.contains(side) && last[side].z() < kAnkle_m + 1e-9;
      if (stays && p.z() < kAnkle_m + 1e-9) {
        fastest_mps = std::max(fastest_mps, (p - last[side]).norm() / kStep_s);
      }
      last[side] = p;
    }
  }
  EXPECT_LT(fastest_mps, 0.41 * kLeg_m / kRadius_m * kSpeed_mps);
  EXPECT_GT(fastest_mps, 0.03);
}

TEST(Walker, StandsInItsStrideUntilItStarts) {
  scenario::Scenario s =
      walking(scenario::Line{.from_m = Vector2d(2, 1), .heading_rad = 0, .speed_mps = 1});
  s.actors[0].start.at_s = 0.5;
  Walk walk(s);
  walk.reach(0.1);
  const Vector3d before = walk.body("/left_shank").p;
  walk.reach(0.5);
  EXPECT_EQ(walk.body("/left_shank").p, before);
  walk.reach(0.6);
  EXPECT_GT((walk.body("/left_shank").p - before).norm(), 0.01);
}

/// A camera beside the way of a walker.
scenario::Scenario crossing() {
  scenario::Scenario s = walking(
      scenario::Line{.from_m = Vector2d(2.2, -0.6), .heading_rad = 1.5707963, .speed_mps = 1.2});
  s.frames = 6;
  s.camera.mount_position_m = {0, 0, 0.8};
  return s;
}

/// Brute force: the pose of a pixel's own geom, from a world without a camera's frames.
TEST(Walker, HasTheMotionOfEachLimbInItsTruth) {
  const scenario::Scenario s = crossing();
  Observer observer(s, WrongStart::refused);
  observer.advance();
  observer.advance();
  const Observation o = observer.observe();
  Walk now(s), next(s);
  now.reach(0.2);
  next.reach(0.3);
  const Pinhole camera = observer.calibration().camera;
  const Model& model = now.world().model();
  std::map<std::string, int> compared;
  std::map<std::string, double> most_own_px;  // motion beyond that of the walker as a whole
  const Pose T_WA = now.body(""), T_WA_next = next.body("");
  for (int y = 3; y < o.geom.rows - 3; y += 2) {
    for (int x = 3; x < o.geom.cols - 3; x += 2) {
      const int geom = o.geom(y, x);
      if (o.truth.object(y, x) != 1) continue;
      double nearest = 0;
      cv::minMaxLoc(o.truth.depth_m(cv::Rect(x - 1, y - 1, 3, 3)), &nearest);
      if (nearest < o.truth.depth_m(y, x)) continue;
      const std::vector<Eigen::Vector2f> corner{{static_cast<float>(x), static_cast<float>(y)}};
      const CornerTruth truth = label_corners(camera, o.truth, corner, 0.5).at(0);
      const Vector3d p_W =
          o.truth.now.T_WC * camera.back_project(Vector2d(x, y), o.truth.depth_m(y, x));
      const Vector3d there_W =
          next.world().model().geom_pose(geom) * (model.geom_pose(geom).inverse() * p_W);
      const Vector2d goal = camera.project(o.truth.next.T_WC.inverse() * there_W);
      EXPECT_LT((truth.motion_px - (goal - Vector2d(x, y))).norm(), 1e-6);
      EXPECT_EQ(truth.object, 1);
      EXPECT_NE(truth.label, Label::fixed) << "a planted foot belongs to a mover";
      const Vector2d whole =
          camera.project(o.truth.next.T_WC.inverse() * (T_WA_next * (T_WA.inverse() * p_W)));
      const std::string name(model.name(mjOBJ_BODY, model.m().geom_bodyid[geom]));
      ++compared[name];
      most_own_px[name] = std::max(most_own_px[name], (goal - whole).norm());
    }
  }
  for (const char* limb : {"ann/left_shank", "ann/right_shank", "ann/trunk", "ann/right_foot"}) {
    EXPECT_GT(compared[limb], 20) << limb;
  }
  EXPECT_GT(std::max(most_own_px["ann/left_shank"], most_own_px["ann/right_shank"]), 10);
  EXPECT_LT(most_own_px["ann/trunk"], 3) << "it only rises and falls";
}

/// The truth of a row is of its time: brute force as above, from worlds at the times of both rows.
TEST(Walker, HasTheMotionOfEachLimbAtTheTimeOfItsRow) {
  scenario::Scenario s = crossing();
  s.camera.width_px = 160;
  s.camera.height_px = 120;
  s.camera.rolling_shutter_s = 0.02;
  Observer observer(s, WrongStart::refused);
  observer.advance();
  const Observation o = observer.observe();
  const Pinhole camera = observer.calibration().camera;
  const Pose T_WC = o.truth.now.T_WC;  // at rest
  int compared = 0;
  for (int y = 70; y < 115; y += 4) {
    for (int x = 4; x < 156; x += 3) {
      const int geom = o.geom(y, x);
      if (o.truth.object(y, x) != 1) continue;
      double nearest = 0;
      cv::minMaxLoc(o.truth.depth_m(cv::Rect(x - 1, y - 1, 3, 3)), &nearest);
      if (nearest < o.truth.depth_m(y, x)) continue;
      const std::vector<Eigen::Vector2f> corner{{static_cast<float>(x), static_cast<float>(y)}};
      const CornerTruth truth = label_corners(camera, o.truth, corner, 0.5).at(0);
      const Vector2d goal = Vector2d(x, y) + truth.motion_px;
      if (goal.y() < 0 || goal.y() > 119) continue;
      Walk now(s), next(s);
      now.reach(0.1 + 0.02 * y / 120);
      next.reach(0.2 + 0.02 * goal.y() / 120);
      const Vector3d p_W = T_WC * camera.back_project(Vector2d(x, y), truth.depth_m);
      const Vector2d there =
          camera.project(T_WC.inverse() * (next.world().model().geom_pose(geom) *
                                           (now.world().model().geom_pose(geom).inverse() * p_W)));
      EXPECT_LT((there - goal).norm(), 1e-3);  // poses between two of 129 instants are interpolated
      ++compared;
    }
  }
  EXPECT_GT(compared, 10);
}

TEST(Walker, IsOneObjectWithAMaskOfAllItsLimbs) {
  const scenario::Scenario s = crossing();
  Observer observer(s, WrongStart::refused);
  observer.advance();
  const Observation o = observer.observe();
  ASSERT_EQ(o.objects.size(), 1u);
  EXPECT_TRUE(o.objects[0].moving);
  EXPECT_GT(o.objects[0].visible_fraction, 0.4);
  EXPECT_EQ(observer.world().objects().size(), 1u);
  EXPECT_EQ(o.truth.now.T_WO.size(), 2u + 11u) << "world, walker, trunk and ten limbs";
  int pixels = 0, limbs = 0;
  for (int y = 0; y < o.geom.rows; ++y) {
    for (int x = 0; x < o.geom.cols; ++x) {
      pixels += o.truth.object(y, x) == 1;
      limbs += o.truth.part(y, x) > 1;
      EXPECT_EQ(o.truth.part(y, x) > 1, o.truth.object(y, x) == 1);
    }
  }
  EXPECT_EQ(pixels, o.objects[0].visible_px);
  EXPECT_EQ(limbs, pixels);
}

/// All of the body in view: its silhouette by its parts is the mask that is rendered.
TEST(Walker, IsVisibleAsAWholeInTheOpen) {
  scenario::Scenario s = crossing();
  std::get<scenario::Line>(s.actors[0].trajectory).from_m = Vector2d(5, -0.6);
  Observer observer(s, WrongStart::refused);
  for (int k = 0; k < 5; ++k) EXPECT_GT(observer.observe().objects.at(0).visible_fraction, 0.97);
}

TEST(Walker, KeepsItsGaitAtAnotherSize) {
  scenario::Scenario s =
      walking(scenario::Line{.from_m = Vector2d(2, 1), .heading_rad = 0, .speed_mps = 1});
  s.actors[0].size_m = Vector3d(0.6, 0.4, 1.2);  // a child
  Walk walk(s);
  int planted = 0;
  std::map<std::string, Vector3d> last;
  for (int i = 0; i < 200; ++i) {
    walk.reach(0.005 * i);
    for (const std::string side : {"/left_", "/right_"}) {
      const Vector3d p = walk.body(side + "foot").p;
      const double ankle_m = kAnkle_m * 1.2 / 1.7;
      const bool stays = last.contains(side) && last[side].z() < ankle_m + 1e-9;
      if (stays && p.z() < ankle_m + 1e-9) {
        EXPECT_LT((p - last[side]).norm() / 0.005, 1e-9);
        ++planted;
      }
      last[side] = p;
    }
  }
  EXPECT_GT(planted, 200);
}

}  // namespace
}  // namespace lcs::sim
