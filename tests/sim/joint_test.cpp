// Doors and drawers of a scene that an actor moves: their places, velocities and truth.

#include <gtest/gtest.h>

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
using test::floor_with;
using test::kDegree;
using test::scenario_error;
using test::scenario_in_mjcf;

constexpr double kWidth_m = 0.9;
const Vector3d kHinge_m(3, -0.45, 0);

/// A door in a frame, whose closed leaf is along y from its hinge; a hatch and a handle in it; and
/// behind it a wall, which is setting.
const std::string kDoor =
    "<geom name='wall' type='box' size='.1 3 1.5' pos='5 0 1.5'/>\n"
    "<body name='door' pos='3 0 0'><geom name='post' type='box' size='.03 .05 1' pos='0 .55 1'/>"
    "<body name='leaf' pos='0 -.45 0'>\n<joint name='hinge' axis='0 0 1' range='-5 100'/>"
    "<geom name='leaf' type='box' size='.02 .45 .99' pos='0 .45 1'/>"
    "<site name='edge' pos='0 .9 1'/>"
    "<body name='handle' pos='-.05 .8 1'>\n<joint name='handle' axis='1 0 0'/>"
    "<geom type='box' size='.01 .06 .01'/></body></body></body>"
    "<body name='cabinet' pos='2 2 .5'><geom type='box' size='.3 .3 .3'/><body name='drawer'>\n"
    "<joint name='slide' type='slide' axis='1 0 0' range='0 .4'/>"
    "<geom type='box' size='.2 .2 .1' pos='0 0 .4'/></body><body name='knob' pos='0 0 .6'>"
    "<joint name='knob' type='ball'/><geom size='.02'/></body></body>";

scenario::Actor moved(const std::string& body, const std::string& joint, double to, bool is_angle) {
  scenario::Actor actor;
  actor.name = actor.body.emplace(body);
  actor.source = {"test.yaml", 7};
  scenario::JointMotion& motion = actor.joints.emplace_back();
  motion.name = joint;
  motion.source = {"test.yaml", 9};
  motion.points = {{0.5, 0, is_angle}, {2.5, to, is_angle}};
  return actor;
}

/// The door opens by 80 degrees from 0.5 to 2.5 s, and the drawer by 0.3 m.
scenario::Scenario opening(double rover_mps = 0) {
  scenario::Scenario s = scenario_in_mjcf(floor_with(kDoor), rover_mps, 30);
  s.actors = {moved("door", "hinge", 80 * kDegree, true), moved("cabinet", "slide", 0.3, false)};
  return s;
}

class Passing {
 public:
  explicit Passing(const scenario::Scenario& s) : world_(s) {}
  void reach(double t_s) { world_.advance_to(std::llround(1e9 * t_s), imu_, odometry_); }
  Pose body(const std::string& name) { return model().body_pose(id(mjOBJ_BODY, name)); }
  Vector3d edge_m() { return model().site_pose(id(mjOBJ_SITE, "edge")).p; }
  Model& model() { return world_.model(); }
  const World& world() const { return world_; }
  int id(mjtObj type, const std::string& name) { return model().id(type, name); }

 private:
  World world_;
  std::vector<ImuSample> imu_;
  std::vector<OdometrySample> odometry_;
};

TEST(MovedJoint, CarriesTheFreeEdgeWhereItsAngleSaysWithTheVelocityOfItsDifferences) {
  Passing passing(opening());
  constexpr double kStep_s = 0.01;
  const auto angle_at = [](double t_s) { return 40 * kDegree * std::clamp(t_s - 0.5, 0.0, 2.0); };
  Vector3d before_m = passing.edge_m();
  for (int i = 1; i <= 300; ++i) {
    const double t_s = kStep_s * i, angle = angle_at(t_s);
    passing.reach(t_s);
    const Vector3d edge_m = passing.edge_m();
    const Vector3d right_m =
        kHinge_m + Vector3d(-kWidth_m * std::sin(angle), kWidth_m * std::cos(angle), 1);
    ASSERT_LT((edge_m - right_m).norm(), 1e-9) << t_s;
    ASSERT_NEAR(passing.body("drawer").p.x(), 2 + 0.3 * angle / (80 * kDegree), 1e-9) << t_s;
    mjtNum v[6];
    mj_objectVelocity(&passing.model().m(), &passing.model().d(), mjOBJ_SITE,
                      passing.id(mjOBJ_SITE, "edge"), v, 0);
    const double speed_mps = (edge_m - before_m).norm() / kStep_s;
    const bool is_at_bend = std::abs(t_s - 0.5) < 1e-9 || std::abs(t_s - 2.5) < 1e-9;
    if (!is_at_bend) {
      ASSERT_NEAR(Vector3d(v[3], v[4], v[5]).norm(), speed_mps, 1e-4) << t_s;
    }
    before_m = edge_m;
  }
  // what does not move: the frame, and the joints that no actor names
  EXPECT_EQ(passing.body("door").p, Vector3d(3, 0, 0));
  EXPECT_NEAR(
      (passing.body("leaf").R.transpose() * passing.body("handle").R - Eigen::Matrix3d::Identity())
          .norm(),
      0, 1e-9);
  const Warnings::Met& told = passing.world().warnings().of(Warning::joints_frozen);
  EXPECT_EQ(told.count, 2);
  EXPECT_NE(told.first.find("stay at zero"), std::string::npos) << told.first;
  EXPECT_EQ(passing.world().warnings().of(Warning::actors_never_moved).count, 0);
}

/// Brute force as for walkers: the pose of a pixel's own geom, from worlds at both times.
TEST(MovedJoint, HasItsMotionInTheTruthOfItsPartsAlone) {
  const scenario::Scenario s = opening(0.2);
  Observer observer(s, WrongStart::refused);
  for (int k = 0; k < 10; ++k) observer.advance();
  const Observation o = observer.observe();
  Passing now(s), next(s);
  now.reach(1.0);
  next.reach(1.1);
  const Pinhole camera = observer.calibration().camera;
  std::map<std::string, int> compared;
  std::map<std::string, std::map<Label, int>> labelled;
  for (int y = 3; y < o.geom.rows - 3; y += 3) {
    for (int x = 3; x < o.geom.cols - 3; x += 3) {
      const int geom = o.geom(y, x);
      if (geom < 0 || o.truth.object(y, x) < 0) continue;
      double nearest = 0;
      cv::minMaxLoc(o.truth.depth_m(cv::Rect(x - 1, y - 1, 3, 3)), &nearest);
      if (nearest < o.truth.depth_m(y, x)) continue;
      const std::vector<Eigen::Vector2f> corner{{static_cast<float>(x), static_cast<float>(y)}};
      const CornerTruth truth = label_corners(camera, o.truth, corner, 0.5).at(0);
      const Vector3d p_W =
          o.truth.now.T_WC * camera.back_project(Vector2d(x, y), o.truth.depth_m(y, x));
      const Vector3d there_W =
          next.model().geom_pose(geom) * (now.model().geom_pose(geom).inverse() * p_W);
      const Vector2d goal = camera.project(o.truth.next.T_WC.inverse() * there_W);
      if (!(goal.norm() < 1e4)) continue;
      EXPECT_LT((truth.motion_px - (goal - Vector2d(x, y))).norm(), 1e-4);
      const std::string name(now.model().name(mjOBJ_GEOM, geom));
      ++compared[name];
      ++labelled[name][truth.label];
    }
  }
  for (const char* geom : {"wall", "post", "leaf"}) EXPECT_GT(compared[geom], 20) << geom;
  EXPECT_GT(labelled["leaf"][Label::rebel], compared["leaf"] / 2);
  EXPECT_EQ(labelled["wall"][Label::fixed], compared["wall"]);
  EXPECT_EQ(labelled["post"][Label::indistinct], compared["post"]) << "of a mover, and at rest";

  ASSERT_GE(o.objects.size(), 1u);
  const ObjectTruth& door = o.objects[0];
  EXPECT_TRUE(door.moving);
  EXPECT_GT(door.visible_fraction, 0.2);
  int pixels = 0;
  for (const int object : o.truth.object) pixels += object == door.object;
  EXPECT_EQ(pixels, door.visible_px);
}

TEST(MovedJoint, MayBeOfTheObjectItself) {
  auto s =
      scenario_in_mjcf(floor_with("<body name='flap' pos='3 0 1'><joint name='flap' axis='0 1 0'/>"
                                  "<geom type='box' size='.3 .3 .01' pos='.3 0 0'/></body>"),
                       0, 30);
  s.actors = {moved("flap", "flap", -90 * kDegree, true)};
  s.actors[0].name = "lid";
  s.actors[0].start.at_s = 0.5;
  Observer observer(s, WrongStart::refused);
  EXPECT_FALSE(observer.observe().objects.at(0).moving);
  for (int k = 1; k < 15; ++k) observer.advance();
  const Observation o = observer.observe();
  EXPECT_TRUE(o.objects.at(0).moving);
  EXPECT_NEAR(std::asin(o.truth.now.T_WO.at(1).R(2, 0)), 0.5 * 45 * kDegree, 1e-9);
}

TEST(MovedJoint, IsSavedAsItStarts) {
  auto s = opening();
  s.actors[0].joints[0].points = {{0, 1.2, true}, {1, 0.2, true}};
  World world(s);
  const Model& model = world.model();
  const Pose T_WL = model.body_pose(model.id(mjOBJ_BODY, "leaf"));
  auto again = scenario_in_mjcf(world.saved(true), 0, 1);
  std::string error(1000, '\0');
  const Spec spec(mj_parseXML(again.scene.c_str(), nullptr, error.data(), 1000));
  ASSERT_TRUE(spec) << error;
  Model saved(*spec);
  mj_kinematics(&saved.m(), &saved.d());
  const Pose T_WS = saved.body_pose(saved.id(mjOBJ_BODY, "leaf"));
  EXPECT_LT((T_WS.p - T_WL.p).norm() + (T_WS.R - T_WL.R).norm(), 1e-5);
}

TEST(MovedJoint, IsNotPushedByARoverOnWheels) {
  auto s = scenario_in_mjcf(
      floor_with("<body name='door' pos='1 -.45 0'><joint name='hinge' axis='0 0 1'/>"
                 "<geom type='box' size='.02 .45 .5' pos='0 .45 .5'/></body>"),
      0.5, 40);
  s.actors = {moved("door", "hinge", 0.001 * kDegree, true)};
  s.ego.drive = scenario::Drive::wheeled;
  Passing passing(s);
  passing.reach(3.5);
  EXPECT_LT(passing.world().T_WB().p.x(), 1) << "it stops the rover";
  EXPECT_NEAR(passing.body("door").R(1, 0), 0, 1e-4);
}

void expect_refused(const scenario::Scenario& s, const std::vector<std::string>& parts) {
  const std::string said = scenario_error([&] { World{s}; });
  for (const std::string& part : parts) {
    EXPECT_NE(said.find(part), std::string::npos) << said << "\n  lacks: " << part;
  }
}

TEST(MovedJoint, OfAnotherNameKindUnitOrBeyondItsRangeIsRefusedAtItsLine) {
  const auto with = [](const scenario::Actor& actor) {
    auto s = opening();
    s.actors = {actor, moved("cabinet", "slide", 0.3, false)};
    return s;
  };
  expect_refused(with(moved("door", "hinges", 1, true)),
                 {"test.yaml:9: joint 'hinges' is not in body 'door'",
                  "its joints are called 'hinge', 'handle'"});
  expect_refused(with(moved("door", "slide", 1, true)), {"'slide' is not in body 'door'"});
  auto knob = opening();
  knob.actors[1] = moved("cabinet", "knob", 1, true);
  expect_refused(knob, {"test.yaml:9: joint 'knob' is a ball or free joint"});
  expect_refused(with(moved("door", "hinge", 1, false)), {"'hinge' is a hinge", "deg or rad"});
  expect_refused(with(moved("door", "hinge", 101 * kDegree, true)),
                 {"test.yaml:9: joint 'hinge' moves to 101 deg, and reaches -5 deg to 100 deg (",
                  ".xml:8); stay within"});
  auto far = opening();
  far.actors[1] = moved("cabinet", "slide", 0.41, false);
  expect_refused(far, {"moves to 0.41 m, and reaches 0 m to 0.4 m"});
  auto unmoved = opening();
  unmoved.actors.pop_back();
  expect_refused(unmoved, {"joint inside another body"});
}

TEST(MovedJoint, StaysBesideTheSceneThatKeepsAPose) {
  std::string mjcf = floor_with(kDoor);
  mjcf.insert(mjcf.rfind("</mujoco>"),
              "<keyframe><key name='home' qpos='1 .5 .1 1 0 0 0'/>"
              "</keyframe>");
  auto s = scenario_in_mjcf(mjcf, 0, 10);
  s.actors = {moved("door", "hinge", 1, true)};
  s.pose = "home";
  Passing passing(s);
  EXPECT_LT((passing.edge_m() - kHinge_m - Vector3d(0, kWidth_m, 1)).norm(), 1e-9);
  EXPECT_NEAR(passing.body("drawer").p.x(), 2.1, 1e-9);
  EXPECT_NEAR(passing.body("handle").R(2, 1), 0, 1e-9) << "it stays at zero";
}

}  // namespace
}  // namespace lcs::sim
