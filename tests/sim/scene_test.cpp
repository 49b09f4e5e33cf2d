// Valid and invalid scenes and actors from the user's point of view.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "sim/scene/silhouette.h"
#include "sim/world/world.h"
#include "tests/sim/support.h"
#include "tests/tools/pictures.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::sim {
namespace {

using Eigen::Vector3d;
using scenario::Shape;
using test::floor_with;
using test::line_actor;
using test::physics_error;
using test::scenario_error;
using test::scenario_in;
using test::scenario_in_mjcf;

constexpr const char* kTwoBodies =
    "<body name='statue' pos='2 0 .5'><geom type='box' size='.2 .2 .5'/></body>"
    "<body name='crate' pos='3 1 .5'><geom type='box' size='.2 .2 .5'/></body>";

void load(const scenario::Scenario& s) {
  World world(s);
}

void expect_error(const scenario::Scenario& s, const std::vector<std::string>& parts) {
  const std::string message = scenario_error([&] { load(s); });
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << message << "\n  lacks: " << part;
  }
}

scenario::Actor moving_body(const std::string& name, const std::string& body) {
  scenario::Actor actor = line_actor(name, Shape::box, {1, 1}, 0, 0.5);
  actor.body = body;
  return actor;
}

TEST(Scene, ObjectsAreNamedBodiesOfTheWorldThenActors) {
  auto s = scenario_in_mjcf(
      floor_with(std::string(kTwoBodies) + "<body pos='5 5 1'><geom size='.1'/></body>"), 0, 1);
  s.actors = {line_actor("walker", Shape::pedestrian, {4, 0}, 0, 1)};
  const World world(s);
  ASSERT_EQ(world.objects().size(), 3u);
  EXPECT_EQ(world.objects()[0].name, "statue");
  EXPECT_EQ(world.objects()[1].name, "crate");
  EXPECT_EQ(world.objects()[2].name, "walker");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(world.objects()[static_cast<std::size_t>(i)].id, i + 1);
}

TEST(Scene, AMovedBodyStaysTheObjectThatItWas) {
  auto s = scenario_in_mjcf(floor_with(kTwoBodies), 0, 1);
  s.actors = {moving_body("thief", "statue")};
  World world(s);
  ASSERT_EQ(world.objects().size(), 2u);
  EXPECT_EQ(world.objects()[0].name, "statue");
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  world.advance_to(2'000'000'000, imu, odometry);
  // along the line, at the height from the scene
  EXPECT_NEAR((world.snapshot().T_WO.at(1).p - Vector3d(2, 1, 0.5)).norm(), 0, 1e-9);
  EXPECT_EQ(world.snapshot().T_WO.at(2).p, Vector3d(3, 1, 0.5));
}

TEST(Scene, AMovedBodyKeepsItsTiltAndTurnsToItsHeading) {
  auto s = scenario_in_mjcf(
      floor_with("<body name='statue' pos='2 0 .5' euler='0 20 50'><geom size='.1'/></body>"), 0,
      1);
  s.actors = {moving_body("thief", "statue")};
  auto& line = std::get<scenario::Line>(s.actors[0].trajectory);
  line.heading_rad.reset();
  line.from_m.reset();
  const World still(s);
  line.heading_rad = 1.0;
  const World turned(s);
  const Eigen::Matrix3d before = still.snapshot().T_WO.at(1).R;
  const Eigen::Matrix3d after = turned.snapshot().T_WO.at(1).R;
  EXPECT_NEAR(std::atan2(after(1, 0), after(0, 0)), 1.0, 1e-9);
  EXPECT_NEAR((after.row(2) - before.row(2)).norm(), 0, 1e-9) << "same tilt against the vertical";
  EXPECT_EQ(still.snapshot().T_WO.at(1).p, Vector3d(2, 0, 0.5));
}

TEST(Scene, AnActorOnABodyThatTheSceneLacksNamesTheNearest) {
  auto s = scenario_in_mjcf(floor_with(kTwoBodies), 0, 1);
  s.actors = {moving_body("thief", "statu")};
  expect_error(s, {"test.yaml:7", "'statu'", "statue"});
  s.actors = {moving_body("statue", "statu")};  // has the name of the intended body
  expect_error(s, {"test.yaml:7", "'statu'", "lacks", "statue"});
  s.scene = scenario_in_mjcf(floor_with(""), 0, 1).scene;
  expect_error(s, {"test.yaml:7", "no named body"});
}

TEST(Scene, TwoActorsCannotMoveOneBody) {
  auto s = scenario_in_mjcf(floor_with(kTwoBodies), 0, 1);
  s.actors = {moving_body("a", "statue"), moving_body("b", "statue")};
  expect_error(s, {"test.yaml:7", "'statue'", "two actors"});
}

TEST(Scene, AnActorCannotBeCalledLikeABody) {
  auto s = scenario_in_mjcf(floor_with(kTwoBodies), 0, 1);
  s.actors = {line_actor("crate", Shape::box, {1, 1}, 0, 1)};
  expect_error(s, {"test.yaml:7", "'crate'"});
  s.actors = {moving_body("crate", "statue")};
  expect_error(s, {"test.yaml:7", "'crate'"});
  s.actors = {moving_body("crate", "crate")};
  EXPECT_NO_THROW(load(s));
}

TEST(Scene, AnAddedActorNeedsAPlace) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  s.actors = {line_actor("walker", Shape::pedestrian, {0, 0}, 0, 1)};
  std::get<scenario::Line>(s.actors[0].trajectory).from_m.reset();
  expect_error(s, {"test.yaml:7", "'walker'", "from"});
}

TEST(Scene, ABodyOfTheSceneHasItsSizeAndTextureAlready) {
  auto s = scenario_in_mjcf(floor_with(kTwoBodies), 0, 1);
  s.actors = {moving_body("thief", "statue")};
  s.actors[0].texture = "bricks";
  expect_error(s, {"test.yaml:7"});
  s.actors[0].texture.clear();
  s.actors[0].size_m = Vector3d(1, 1, 1);
  expect_error(s, {"test.yaml:7"});
}

TEST(Scene, MissingOrMalformedFilesAreNamedWithTheirLine) {
  auto s = scenario_in("lab", 0, 1);
  s.scene = "/nonexistent/scene.xml";
  expect_error(s, {"test.yaml:2", "/nonexistent/scene.xml"});

  s = scenario_in_mjcf("<mujoco>\n  <worldbody>\n  <geom size='1'>\n</mujoco>\n", 0, 1);
  expect_error(s, {s.scene.string() + ":", "XML"});

  s = scenario_in_mjcf("<svg/>", 0, 1);
  expect_error(s, {s.scene.string() + ":1", "MJCF"});

  s = scenario_in_mjcf("", 0, 1);
  expect_error(s, {s.scene.string()});
}

TEST(Scene, MujocoErrorIsPassedOn) {
  const auto s = scenario_in_mjcf(floor_with("<geom type='box' size='-1 1 1'/>"), 0, 1);
  expect_error(s, {s.scene.string(), "size"});
}

TEST(Scene, AMissingTextureFileIsNamedWithItsLine) {
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<worldbody>"),
              "<asset>\n<texture name='t' type='2d' file='gone.png'/>\n</asset>");
  const auto s = scenario_in_mjcf(mjcf, 0, 1);
  expect_error(s, {s.scene.string() + ":4", "gone.png"});
}

TEST(Scene, TexturesAndIncludesBesideTheSceneAreFound) {
  const std::filesystem::path folder = lcs::test::folder_of_the_process();
  lcs::test::write_picture(folder / "beside.png", cv::Mat3b(8, 8, cv::Vec3b(0, 0, 255)));
  std::ofstream(folder / "beside.xml")
      << "<mujoco><worldbody><body name='included' pos='3 0 0'><geom type='box' size='.5 .5 .5' "
         "material='m'/></body></worldbody></mujoco>";
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<worldbody>"),
              "<asset><texture name='t' type='2d' file='beside.png'/>"
              "<material name='m' texture='t'/></asset><include file='beside.xml'/>");
  const World world(scenario_in_mjcf(mjcf, 0, 1));
  EXPECT_EQ(world.objects().at(0).name, "included");
}

TEST(Scene, APipeOrADeviceIsRefusedWhereItIsNamedAndNotWaitedFor) {
  const std::filesystem::path pipe = lcs::test::folder_of_the_process() / "pipe";
  std::filesystem::remove(pipe);
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto s = scenario_in("lab", 0, 1);
  s.scene = pipe;
  expect_error(s, {"test.yaml:2: ", "this is a pipe"});
  for (const std::string& element :
       {"<include file='" + pipe.string() + "'/>",
        "<asset><texture name='t' type='2d' file='" + pipe.string() + "'/></asset>",
        "<asset><mesh name='m' file='" + pipe.string() + "'/></asset>",
        "<asset><hfield name='h' size='1 1 1 1' file='" + pipe.string() + "'/></asset>"}) {
    std::string mjcf = floor_with("");
    mjcf.insert(mjcf.find("<worldbody>"), element + "\n");
    s = scenario_in_mjcf(mjcf, 0, 1);
    expect_error(s, {s.scene.string() + ":3: ", "this is a pipe", "; write what comes out"});
  }
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<worldbody>"), "<include file='/dev/zero'/>\n");
  expect_error(scenario_in_mjcf(mjcf, 0, 1), {"'/dev/zero': this is a device"});
}

TEST(Scene, ANulByteIsNoEndOfFile) {
  std::string mjcf = floor_with("");
  mjcf += std::string(1, '\0') + "<more/>";
  expect_error(scenario_in_mjcf(mjcf, 0, 1), {"there is a NUL byte"});
}

TEST(Scene, FilesThatIncludeEachOtherTwiceAreRefused) {
  const std::filesystem::path folder = lcs::test::folder_of_the_process();
  for (int i = 0; i < 12; ++i) {
    std::ofstream file(folder / ("twice" + std::to_string(i) + ".xml"));
    file << "<mujoco>";
    for (int k = 0; k < 2 && i < 11; ++k) file << "<include file='twice" << i + 1 << ".xml'/>";
    file << (i < 11 ? "</mujoco>" : "<worldbody/></mujoco>");
  }
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<worldbody>"), "<include file='twice0.xml'/>");
  expect_error(scenario_in_mjcf(mjcf, 0, 1), {"more files are included"});
}

TEST(Scene, AnIncludeOfItselfEnds) {
  std::string mjcf = floor_with("");
  const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
  mjcf.insert(mjcf.find("<worldbody>"), "<include file='" + name + ".xml'/>");
  expect_error(scenario_in_mjcf(mjcf, 0, 1), {"nested too deep"});
}

std::string with_option(const std::string& option, const std::string& more) {
  std::string mjcf = floor_with(more);
  mjcf.insert(mjcf.find("<statistic"), option);
  return mjcf;
}

/// A spring of 4e6 N/m on 1 kg swings with 2000 rad/s, stable below 1 ms.
TEST(Scene, KeepsAShorterTimestepAndSwingsAsTheEquationSays) {
  const std::string spring =
      "<body name='gate' pos='9 0 1'><joint type='slide' axis='0 1 0' stiffness='4e6' "
      "springref='.01'/><geom type='box' size='.2 .2 .2' mass='1'/></body>";
  World world(scenario_in_mjcf(with_option("<option timestep='1e-5'/>", spring), 0, 2));
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  for (std::int64_t t_ns = 1'000'000; t_ns <= 30'000'000; t_ns += 1'000'000) {
    world.advance_to(t_ns, imu, odometry);
    const double expected_m = .01 * (1 - std::cos(2000 * 1e-9 * static_cast<double>(t_ns)));
    EXPECT_NEAR(world.snapshot().T_WO.at(1).p.y(), expected_m, 5e-4) << t_ns;
  }
  EXPECT_EQ(world.warnings().of(Warning::options_replaced).count, 0);
}

/// What MuJoCo warns of is a warning here, at the element's line.
TEST(Scene, LoadsWhatMujocoWarnsOf) {
  const auto s = scenario_in_mjcf(
      floor_with("\n<body name='b' pos='3 0 1'><geom size='.1'/><flexcomp name='cloth' type='grid' "
                 "count='3 3 1' spacing='.1 .1 .1' radius='.01' dim='2' mass='1'/></body>"),
      0, 1);
  auto posed = s;
  posed.pose = scenario::kPoseZero;
  const World world(posed);
  const Warnings::Met& told = world.warnings().of(Warning::mujoco_warnings);
  EXPECT_GE(told.count, 1);
  EXPECT_NE(told.first.find(s.scene.string()), std::string::npos) << told.first;
  EXPECT_NE(told.first.find("flex 'cloth' is not rigid"), std::string::npos) << told.first;
}

constexpr const char* kCabinet =
    "<body name='cabinet' pos='4 0 .5'><geom type='box' size='.3 .3 .5'/>"
    "<body name='door' pos='-.31 -.3 0'><joint name='hinge' axis='0 0 1'/>"
    "<geom type='box' size='.01 .3 .4' pos='0 .3 0'/></body>"
    "<body name='drawer' pos='0 0 .6'><joint name='slide' type='slide' axis='1 0 0'/>"
    "<geom type='box' size='.2 .2 .05'/></body></body>"
    "<body name='ball' pos='6 0 .2'><freejoint/><geom size='.2'/></body>"
    "<body pos='6 2 .2'><freejoint/><geom size='.2'/></body>";

TEST(Scene, KeepsAPoseOfItsJointsAndElseNamesTheFirst) {
  std::string mjcf = floor_with(kCabinet);
  mjcf.insert(
      mjcf.rfind("</mujoco>"),
      "<actuator><position joint='hinge'/></actuator><keyframe><key name='open' qpos='1.5708 "
      ".25 6 1 .2 1 0 0 0 6 2 .2 1 0 0 0'/></keyframe>");
  auto s = scenario_in_mjcf(mjcf, 0, 3);
  expect_error(s, {s.scene.string() + ":", "'door' (and 1 more)", "give the scenario a pose"});
  s.pose = "open";
  World world(s);
  const Model& model = world.model();
  const Pose door = model.body_pose(model.id(mjOBJ_BODY, "door"));
  EXPECT_NEAR(door.R(1, 0), 1, 1e-4) << door.R;
  EXPECT_NEAR(model.body_pose(model.id(mjOBJ_BODY, "drawer")).p.x(), 4.25, 1e-9);
  EXPECT_NEAR(model.body_pose(model.id(mjOBJ_BODY, "ball")).p.y(), 1, 1e-9);
  const Warnings::Met& told = world.warnings().of(Warning::joints_frozen);
  EXPECT_EQ(told.count, 1);
  EXPECT_NE(told.first.find("the scene keeps the pose 'open'"), std::string::npos) << told.first;
  const Warnings::Met& named = world.warnings().of(Warning::bodies_named);
  EXPECT_EQ(named.count, 1);
  EXPECT_NE(named.first.find("'body[3]'"), std::string::npos) << named.first;
  EXPECT_EQ(world.objects().back().name, "body[3]");
  // nothing but the loose bodies moves
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  world.advance_to(200'000'000, imu, odometry);
  EXPECT_EQ(model.body_pose(model.id(mjOBJ_BODY, "door")).R, door.R);
  s.pose = "shut";
  expect_error(s, {"the scene has the pose 'shut'", "choose one of zero, open"});
}

TEST(Scene, AnUnknownTextureStyleOfTheSceneNamesTheKnownOnes) {
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<worldbody>"),
              "<asset><texture name='procedural:brocks' type='2d' builtin='flat' width='8' "
              "height='8'/></asset>");
  const auto s = scenario_in_mjcf(mjcf, 0, 1);
  expect_error(s, {s.scene.string() + ":3: ", "brocks", "bricks"});
}

TEST(Scene, GravityMustPointDown) {
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<statistic"), "<option gravity='0 1 -9.81'/>");
  expect_error(scenario_in_mjcf(mjcf, 0, 1), {"gravity"});
}

TEST(Scene, APlaneIsSettingAndNoObject) {
  expect_error(scenario_in_mjcf(floor_with("<body name='rug'><geom type='plane' size='1 1 1' "
                                           "contype='0' conaffinity='0'/></body>"),
                                0, 1),
               {"'rug'", "plane"});
}

TEST(Scene, ItsOwnCamerasAreNotTheRoversAndChangeNothing) {
  const std::string wall = "<geom type='box' pos='4 0 1' size='.1 2 1' rgba='.8 .2 .2 1'/>";
  const std::string cameras =
      "<camera name='above' pos='0 0 9'/><camera name='beside' pos='0 -3 1' euler='90 0 0'/>";
  Simulation without(scenario_in_mjcf(floor_with(wall), 0.5, 2));
  Simulation with_two(scenario_in_mjcf(floor_with(cameras + wall), 0.5, 2));
  const Observation expected = *without.next(), seen = *with_two.next();
  EXPECT_EQ(seen.truth.now.T_WC.p, expected.truth.now.T_WC.p);
  EXPECT_EQ(cv::norm(seen.image, expected.image, cv::NORM_INF), 0);
}

TEST(Scene, ABodyThatCanMoveMovesAsOne) {
  expect_error(
      scenario_in_mjcf(floor_with("<body name='door' pos='0 3 1'><geom size='.1'/>"
                                  "<body name='wing'><joint/><geom size='.1'/></body></body>"),
                       0, 1),
      {"'wing'"});
}

/// Extent of an actor's geoms along its x, y, z, m, when it stands at the origin heading along x.
Vector3d extent(const scenario::Actor& actor) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  s.actors = {actor};
  World world(s);
  mj_forward(&world.model().m(), &world.model().d());
  Vector3d low = Vector3d::Constant(1e9);
  Vector3d high = -low;
  for (int geom = 0; geom < world.model().m().ngeom; ++geom) {
    if (world.object_of_geom(geom) != 1) continue;
    const Pose T_WG = world.model().geom_pose(geom);
    const Eigen::Matrix3Xd hull = (T_WG.R * geom_hull(world.model().m(), geom)).colwise() + T_WG.p;
    low = low.cwiseMin(hull.rowwise().minCoeff());
    high = high.cwiseMax(hull.rowwise().maxCoeff());
  }
  EXPECT_NEAR(low.z(), 0, 0.01) << "stands on the ground";
  return high - low;
}

TEST(ActorShape, HasTheNaturalSizeThatItStates) {
  // sizes in the fragments' `size`; rounded limbs are exact to a centimetre or two
  const auto actor = [](Shape shape) { return line_actor("a", shape, {6, 0}, 0, 0); };
  EXPECT_NEAR((extent(actor(Shape::box)) - Vector3d(0.5, 0.5, 0.5)).norm(), 0, 1e-9);
  EXPECT_NEAR((extent(actor(Shape::cylinder)) - Vector3d(0.5, 0.5, 0.8)).norm(), 0, 1e-3);
  EXPECT_NEAR((extent(actor(Shape::pedestrian)) - Vector3d(0.7, 0.56, 1.76)).norm(), 0, 0.03);
  EXPECT_NEAR((extent(actor(Shape::car)) - Vector3d(4.2, 1.8, 1.44)).norm(), 0, 0.03);
  EXPECT_NEAR((extent(actor(Shape::walker)) - Vector3d(0.79, 0.57, 1.7)).norm(), 0, 0.03);
}

TEST(ActorShape, IsScaledToTheSizeAskedFor) {
  const std::vector<std::pair<Shape, Vector3d>> asked = {{Shape::box, {1.2, 0.3, 0.7}},
                                                         {Shape::cylinder, {0.9, 0.9, 0.4}},
                                                         {Shape::pedestrian, {0.6, 0.5, 1.6}},
                                                         {Shape::car, {5, 2, 1.5}}};
  for (const auto& [shape, size] : asked) {
    scenario::Actor actor = line_actor("a", shape, {6, 0}, 0, 0);
    actor.size_m = size;
    // round parts stay round where the factors differ: within 3 % of the whole
    EXPECT_LT(((extent(actor) - size).cwiseQuotient(size)).cwiseAbs().maxCoeff(), 0.04)
        << extent(actor).transpose();
  }
}

TEST(ActorShape, ACylinderIsRound) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  s.actors = {line_actor("drum", Shape::cylinder, {1, 0}, 0, 0)};
  s.actors[0].size_m = Vector3d(1, 0.5, 1);
  expect_error(s, {"test.yaml:7", "round"});
}

TEST(ActorShape, TextureIsAStyleOrAPictureAndElseAnError) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  for (const Shape shape : {Shape::box, Shape::cylinder, Shape::pedestrian, Shape::car}) {
    s.actors = {line_actor("a", shape, {6, 0}, 0, 0)};
    s.actors[0].texture = "bricks";
    EXPECT_NO_THROW(load(s));
    s.actors[0].texture = "brocks";
    expect_error(s, {"test.yaml:7", "brocks", "bricks"});
  }
  const std::string file = lcs::test::folder_of_the_process() / "no_picture.png";
  std::ofstream(file) << "text";
  s.actors[0].texture = file;
  expect_error(s, {"test.yaml:7", "no_picture.png"});
}

TEST(ActorShape, APictureIsShownUprightAndNotMirrored) {
  // white, with a blue upper left quarter, which a box before the camera must show on its face
  cv::Mat3b picture(64, 64, cv::Vec3b(255, 255, 255));
  picture(cv::Rect(0, 0, 32, 32)).setTo(cv::Vec3b(255, 0, 0));
  const std::string file = lcs::test::folder_of_the_process() / "quarter.png";
  lcs::test::write_picture(file, picture);
  for (const double heading : {0.0, 90.0, 180.0, 270.0}) {
    auto s = scenario_in_mjcf(floor_with(""), 0, 1);
    s.actors = {line_actor("box", Shape::box, {2, 0}, heading * test::kDegree, 0)};
    s.actors[0].size_m = Vector3d(1, 1, 0.9);
    s.actors[0].texture = file;
    const Observation o = Simulation(s).next().value();
    const ObjectTruth box = o.objects.at(0);
    const auto bluish = [&](double across, double down) {
      const cv::Vec3b c = o.image(static_cast<int>(box.top + down * (box.bottom - box.top)),
                                  static_cast<int>(box.left + across * (box.right - box.left)));
      return c[0] > 2 * c[2];
    };
    EXPECT_TRUE(bluish(0.25, 0.25)) << "heading " << heading;
    EXPECT_FALSE(bluish(0.75, 0.25)) << "heading " << heading;
    EXPECT_FALSE(bluish(0.25, 0.75)) << "heading " << heading;
    EXPECT_FALSE(bluish(0.75, 0.75)) << "heading " << heading;
  }
}

TEST(Scene, AFolderOfOnesOwnScenesNeedsNoRoversAndActors) {
  setenv("LCS_SCENES", lcs::test::folder_of_the_process().c_str(), 1);
  auto s = scenario_in("lab", 0, 1);
  s.actors = {line_actor("a", Shape::box, {2, 0}, 0, 0)};
  EXPECT_NO_THROW(load(s));
  unsetenv("LCS_SCENES");
}

TEST(ActorShape, AnUnknownOneIsRefused) {
  const auto actor = line_actor("a", static_cast<Shape>(99), {2, 0}, 0, 0);
  auto s = scenario_in("lab", 0, 1);
  s.actors = {actor};
  EXPECT_THROW(World world(s), std::invalid_argument);
}

// Textures painted later are plain there, but the file is complete.
TEST(Scene, EachFileLoadsAloneAsAViewerLoadsIt) {
  install_mujoco_handlers();
  const std::filesystem::path scenes = std::filesystem::path(LCS_SOURCE_DIR) / "scenes";
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes)) {
    if (entry.path().extension() != ".xml") continue;
    ++files;
    std::array<char, 1000> message{};
    const std::unique_ptr<mjModel, ModelDeleter> model(
        mj_loadXML(entry.path().c_str(), nullptr, message.data(), message.size()));
    EXPECT_TRUE(model) << entry.path() << ": " << message.data();
    EXPECT_STREQ(message.data(), "") << entry.path();
  }
  EXPECT_EQ(files, 11);
}

TEST(Scene, ActorsOfOneShapeDoNotClash) {
  auto s = scenario_in("lab", 0, 1);
  for (int i = 0; i < 4; ++i) {
    s.actors.push_back(line_actor("car" + std::to_string(i), Shape::car, {0, i - 2}, 0, 1));
    s.actors.back().size_m = {2, .8, .7};
  }
  EXPECT_NO_THROW(load(s));
}

// A scene made for a viewer sets other options too; the sensors need the simulation's own.
TEST(Scene, OptionsOfASceneDoNotSpoilTheSensors) {
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<statistic"),
              "<compiler fusestatic='true'/><option integrator='RK4' timestep='0.05'>"
              "<flag sensor='disable' actuation='disable'/></option>");
  mjcf.insert(mjcf.find("</worldbody>"), "<body name='b' pos='3 0 1'><geom size='.1'/></body>");
  World world(scenario_in_mjcf(mjcf, 0.5, 1));
  EXPECT_EQ(world.objects().size(), 1u);
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  world.advance_to(1'000'000'000, imu, odometry);
  EXPECT_NEAR(imu.back().accel_mps2.z(), 9.81, 1e-6);
  EXPECT_NEAR(world.v_WB_mps().x(), 0.5, 1e-6);
}

TEST(Physics, BodyThroughTheFloorLeavesSightAndTheRunGoesOn) {
  const std::string stone =
      "<body name='stone' pos='3 0 .4'><freejoint/>"
      "<geom size='.2' contype='0' conaffinity='0'/></body>";
  Simulation simulation(scenario_in_mjcf(floor_with(stone), 0, 20));
  const auto is_seen = [](const Observation& frame) {
    return std::any_of(frame.objects.begin(), frame.objects.end(),
                       [](const ObjectTruth& object) { return object.visible_px > 0; });
  };
  EXPECT_TRUE(is_seen(*simulation.next()));
  std::optional<Observation> last;
  while (std::optional<Observation> frame = simulation.next()) last = std::move(frame);
  EXPECT_EQ(last->index, 19);
  EXPECT_FALSE(is_seen(*last));
  EXPECT_LT(last->truth.now.T_WO.at(1).p.z(), -10);
}

TEST(Physics, ADivergingModelEndsTheRunWithTheSimulatedTime) {
  // a ball on a spring with k h^2 / m = 4.4 at steps of 5/3 ms: beyond 4 each swing exceeds
  // the last
  const std::string unstable =
      "<body name='ball' pos='0 3 2'><joint type='slide' axis='0 0 1' stiffness='160000' "
      "springref='.01'/><geom size='.1' mass='.1'/></body>";
  const std::string message =
      physics_error(scenario_in_mjcf(floor_with(unstable), 0, 1), 5'000'000'000);
  ASSERT_NE(message.find(" s of simulated time"), std::string::npos) << message;
  const double t = std::stod(message.substr(message.find("at ") + 3));
  EXPECT_GT(t, 0);
  EXPECT_LT(t, 5);
  EXPECT_NE(message.find("(body 'ball')"), std::string::npos) << message;
  EXPECT_NE(message.find("; look for huge masses"), std::string::npos) << message;
}

TEST(Physics, EngineErrorIsToldWithTheSimulatedTime) {
  // too little memory for a step: an error of the engine, whereas divergence is a warning
  std::string mjcf =
      floor_with("<body name='ball' pos='3 0 1'><freejoint/><geom size='.1'/></body>");
  mjcf.insert(mjcf.find("<statistic"), "<size memory='2K'/>");
  const std::string message = physics_error(scenario_in_mjcf(mjcf, 0, 1), 5'000'000'000);
  EXPECT_NE(message.find(" s of simulated time"), std::string::npos) << message;
}

}  // namespace
}  // namespace lcs::sim
