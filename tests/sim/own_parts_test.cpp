// Rovers and actors from the user's files: valid ones, and the message for each breach of the
// contract.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/load.h"
#include "sim/scene/silhouette.h"
#include "sim/world/world.h"
#include "tests/sim/support.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::sim {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;
using test::floor_with;
using test::line_actor;
using test::scenario_error;
using test::scenario_in_mjcf;

constexpr std::int64_t kSecond = 1'000'000'000;

/// A folder for files whose parts have separate lines.
class OwnPart : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  static scenario::Actor own_actor(const std::string& name, const fs::path& file) {
    scenario::Actor actor = line_actor(name, scenario::Shape::own, {4, 0}, 0, 0.5);
    actor.shape_file = file;
    return actor;
  }

  static scenario::Scenario on_floor() { return scenario_in_mjcf(floor_with(""), 0.5, 1); }

  /// The error message of loading must begin with the file and the line.
  static void expect_refused(const scenario::Scenario& s, const fs::path& file, int line,
                             const std::vector<std::string>& words) {
    testing::internal::CaptureStderr();
    const std::string message = scenario_error([&] { World world(s); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(message.find(file.string() + ":" + std::to_string(line) + ": "), 0u)
        << message << "\n  is not at line " << line << " of the file";
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& word : words) {
      EXPECT_NE(message.find(word), std::string::npos) << message << "\n  lacks: " << word;
    }
  }

  const fs::path folder_ = lcs::test::folder_of_the_process() /
                           testing::UnitTest::GetInstance()->current_test_info()->name();
};

// ---- The worked example of scenes/README.md

TEST(Warehouse, TheOwnRoverIsWhereItIsToldAndTheOwnForkliftsAreSeenToMove) {
  const scenario::Scenario s =
      scenario::load(fs::path(LCS_SOURCE_DIR) / "scenarios/examples/warehouse/warehouse.yaml",
                     {.sets = {"camera.size=[160, 120]", "camera.focal=105"}, .seed = {}});
  Simulation simulation(s);
  EXPECT_NEAR(simulation.calibration().camera.focal_px, 105, 1e-9);
  const Pose T_CB = simulation.calibration().T_BC.inverse();
  std::map<std::string, int> seen, moving;
  while (const auto o = simulation.next()) {
    for (const scenario::Waypoint& point : s.ego.waypoints) {
      if (std::llround(point.at_s * 1e9) != o->t_ns) continue;
      const Pose T_WB = o->truth.now.T_WC * T_CB;
      EXPECT_LT((T_WB.p.head<2>() - point.position_m).norm(), 0.02) << point.at_s << " s";
    }
    for (const ObjectTruth& object : o->objects) {
      const std::string& name =
          simulation.objects()[static_cast<std::size_t>(object.object) - 1].name;
      if (object.visible_fraction < 0.3) continue;
      ++seen[name];
      moving[name] += object.moving;
    }
  }
  for (const char* truck : {"crossing_truck", "coming_truck"}) {
    EXPECT_GT(seen[truck], 20) << truck;
    EXPECT_GT(moving[truck], 20) << truck;
  }
  EXPECT_GT(seen["rack_left_1"], 20);
  EXPECT_EQ(moving["rack_left_1"], 0);
  for (std::size_t i = 0; i < kWarnings.size(); ++i) {
    EXPECT_EQ(simulation.warnings().of(static_cast<Warning>(i)).first, "");
  }
}

// ---- Actors

class OwnActor : public OwnPart {
 protected:
  struct Parts {
    // on lines 2 to 5, and 7; the body has line 6
    std::string top = {}, size = kSize, asset = {}, beside = {};
    std::string base = "<body name='base'>";
    std::string inside = "<geom type='box' pos='0 0 .5' size='.5 .25 .5'/>";
  };
  static constexpr const char* kSize = "<custom><numeric name='size' data='1 .5 1'/></custom>";

  fs::path file(const Parts& p) const {
    return write("truck.xml", "<mujoco>\n" + p.top + "\n" + p.size + "\n" + p.asset +
                                  "\n<worldbody>" + p.beside + "\n" + p.base + "\n" + p.inside +
                                  "</body></worldbody></mujoco>");
  }
  void expect(const Parts& parts, int line, const std::vector<std::string>& words,
              const std::string& texture = "") const {
    auto s = on_floor();
    s.actors = {own_actor("truck", file(parts))};
    s.actors[0].texture = texture;
    expect_refused(s, folder_ / "truck.xml", line, words);
  }

  /// Extent of the first actor's geoms along x, y and z of its body.
  static std::pair<Vector3d, Vector3d> extent(const World& world) {
    const int body = world.body_of(1);
    const Pose T_BW = world.model().body_pose(body).inverse();
    Vector3d low = Vector3d::Constant(1e9), high = -low;
    for (int geom = 0; geom < world.model().m().ngeom; ++geom) {
      if (world.object_of_geom(geom) != 1) continue;
      const Pose T_BG = T_BW * world.model().geom_pose(geom);
      const Eigen::Matrix3Xd hull =
          (T_BG.R * geom_hull(world.model().m(), geom)).colwise() + T_BG.p;
      low = low.cwiseMin(hull.rowwise().minCoeff());
      high = high.cwiseMax(hull.rowwise().maxCoeff());
    }
    return {low, high};
  }
};

/// A tetrahedron over the unit square's corner.
constexpr const char* kObj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST_F(OwnActor, OfSeveralPartsAMeshAndATextureBesideItIsAnObjectThatMoves) {
  fs::create_directories(folder_ / "meshes");
  write("meshes/fork.obj", kObj);
  lcs::test::write_picture(folder_ / "wood.png", cv::Mat3b(8, 8, cv::Vec3b(40, 90, 160)));
  auto s = on_floor();
  s.actors = {own_actor(
      "truck", file({.top = "<compiler meshdir='meshes'/>",
                     .asset = "<asset><mesh file='fork.obj'/><texture name='wood' type='2d' "
                              "file='wood.png'/><material name='m' texture='wood'/></asset>",
                     .inside = "<geom type='box' pos='0 0 .5' size='.5 .25 .5' material='m'/><body "
                               "pos='.5 0 0'><geom type='mesh' mesh='fork'/></body>"}))};
  World world(s);
  ASSERT_EQ(world.objects().size(), 1u);
  EXPECT_EQ(world.objects()[0].name, "truck");
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  world.advance_to(2 * kSecond, imu, odometry);
  EXPECT_NEAR((world.snapshot().T_WO.at(1).p - Vector3d(5, 0, 0)).norm(), 0, 1e-9);
  const auto [low, high] = extent(world);
  EXPECT_NEAR((low - Vector3d(-.5, -.25, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((high - Vector3d(1.5, 1, 1)).norm(), 0, 1e-6);
}

TEST_F(OwnActor, IsScaledWithAllThatIsInIt) {
  write("fork.obj", kObj);
  // all frames are rotated: the mesh reaches 1 m along y, z and x of the actor, from (0, .1, .2);
  // one mesh twice in different attitudes; sizes, types and meshes come from classes
  auto s = on_floor();
  s.actors = {own_actor(
      "truck",
      file({.top = "<default><default class='fork'><geom type='mesh' "
                   "mesh='fork'/></default><default class='block'><geom type='box' "
                   "size='.1 .2 .3'/></default></default>",
            .asset = "<asset><mesh file='fork.obj'/></asset>",
            .inside =
                "<body pos='0 .1 .2' euler='0 0 90'><geom class='fork' euler='90 0 0'/></body>"
                "<geom class='fork' pos='0 .1 .2'/>"
                "<geom class='block' pos='.5 0 .3'/>"}))};
  const auto [low, high] = extent(World(s));
  s.actors[0].size_m = Vector3d(2, 1.5, 4);  // from 1, 0.5, 1: times two, three, four
  const auto [scaled_low, scaled_high] = extent(World(s));
  EXPECT_NEAR((scaled_low - low.cwiseProduct(Vector3d(2, 3, 4))).norm(), 0, 1e-5)
      << low.transpose() << " to " << scaled_low.transpose();
  EXPECT_NEAR((scaled_high - high.cwiseProduct(Vector3d(2, 3, 4))).norm(), 0, 1e-5)
      << high.transpose() << " to " << scaled_high.transpose();
}

/// Uneven scaling shears what is turned: vertices go where the actor's axes say.
TEST_F(OwnActor, ScalesMeshesAlongItsOwnAxesHoweverTheyAreTurned) {
  write("fork.obj", kObj);
  auto s = on_floor();
  s.actors = {
      own_actor("truck", file({.asset = "<asset><mesh file='fork.obj'/></asset>",
                               .inside = "<body pos='.1 .2 .3' euler='10 20 30'><geom type='mesh' "
                                         "mesh='fork' pos='.1 0 0' euler='40 50 60'/></body>"}))};
  const auto [low, high] = extent(World(s));
  s.actors[0].size_m = Vector3d(2, 1.5, 4);
  const auto [scaled_low, scaled_high] = extent(World(s));
  EXPECT_LT((scaled_low - low.cwiseProduct(Vector3d(2, 3, 4))).norm(), 1e-5);
  EXPECT_LT((scaled_high - high.cwiseProduct(Vector3d(2, 3, 4))).norm(), 1e-5);
}

TEST_F(OwnActor, MeansTheSameInASceneOfOtherAnglesAndDefaults) {
  const std::string scene = floor_with("");
  std::string other = scene;
  other.insert(other.find("<statistic"),
               "<compiler angle='radian' eulerseq='zyx'/><default><geom type='capsule' rgba='1 0 0 "
               "0' group='4'/></default>");
  const fs::path truck =
      file({.top = "<compiler eulerseq='XYZ'/><default><geom rgba='0 1 0 1'/></default>",
            .inside = "<geom type='box' size='.1 .2 .3' euler='30 40 50' pos='0 0 .5'/>"
                      "<geom size='.1' pos='0 0 .2'/><geom type='box' size='.1 .2 .3' pos='0 0 .5' "
                      "axisangle='1 1 0 70'/><geom type='box' size='.1 .2 .3' pos='0 0 .5' "
                      "zaxis='1 2 3'/><geom type='box' size='.1 .2 .3' pos='0 0 .5' "
                      "zaxis='0 0 -1'/><geom type='box' size='.1 .2 .3' pos='0 0 .5' "
                      "xyaxes='1 1 0 -1 1 .5'/>"});
  const auto load = [&](const std::string& mjcf) {
    auto s = scenario_in_mjcf(mjcf, 0.5, 1);
    s.actors = {own_actor("truck", truck)};
    return World(s);
  };
  // alone, as MuJoCo itself loads it
  install_mujoco_handlers();
  std::array<char, 1000> said{};
  const std::unique_ptr<mjModel, ModelDeleter> alone(
      mj_loadXML(truck.c_str(), nullptr, said.data(), said.size()));
  ASSERT_TRUE(alone) << said.data();
  for (const std::string& mjcf : {scene, other}) {
    const World world = load(mjcf);
    const mjModel& m = world.model().m();
    int parts = 0;
    for (int geom = 0; geom < m.ngeom; ++geom) {
      if (world.object_of_geom(geom) != 1) continue;
      EXPECT_EQ(m.geom_type[geom], alone->geom_type[parts]);
      EXPECT_EQ(m.geom_rgba[4 * geom + 1], 1);
      EXPECT_EQ(m.geom_rgba[4 * geom + 3], 1);
      EXPECT_EQ(m.geom_group[geom], 0);
      for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(m.geom_quat[4 * geom + i], alone->geom_quat[4 * parts + i], 1e-12)
            << "geom " << parts;
      }
      ++parts;
    }
    EXPECT_EQ(parts, alone->ngeom);
    // and the scene is unchanged: its floor keeps its colour
    EXPECT_EQ(m.geom_rgba[1], .5f);
  }
}

TEST_F(OwnActor, OfAnArticulatedModelKeepsThePoseAskedFor) {
  // a leg of 1 m hangs from a hinge at 1 m above the ground; the keyframe lowers the trunk to 0.8 m
  // and turns the leg forward
  write("dog.xml",
        "<mujoco>\n<option timestep='.01'/><compiler angle='radian'/>\n<worldbody><body "
        "name='trunk' pos='0 0 1'><freejoint/>\n<geom size='.01'/><body name='leg'><joint "
        "name='hip' axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0 0 -1' size='.05'/></body>"
        "</body></worldbody>\n<actuator><position joint='hip'/></actuator>\n<keyframe><key "
        "name='home' qpos='0 0 .8 1 0 0 0 -1.5707963267948966'/></keyframe></mujoco>");
  const fs::path truck = file({.asset = "<asset><model name='dog' file='dog.xml'/></asset>",
                               .inside = "<attach model='dog' body='trunk' prefix='d/'/>"});
  const auto posed = [&](const std::string& pose, const Vector3d& size) {
    auto s = on_floor();
    s.actors = {own_actor("truck", truck)};
    s.actors[0].pose = pose;
    s.actors[0].size_m = size;
    return s;
  };
  const Vector3d natural(1, .5, 1);
  const auto [hung_low, hung_high] = extent(World(posed("zero", natural)));
  EXPECT_NEAR((hung_low - Vector3d(-.05, -.05, -.05)).norm(), 0, 1e-6) << hung_low.transpose();
  const auto [low, high] = extent(World(posed("home", natural)));
  EXPECT_NEAR((low - Vector3d(-.05, -.05, .75)).norm(), 0, 1e-6) << low.transpose();
  EXPECT_NEAR((high - Vector3d(1.05, .05, .85)).norm(), 0, 1e-6) << high.transpose();
  const World home(posed("home", natural));
  const Warnings::Met& told = home.warnings().of(Warning::joints_frozen);
  EXPECT_EQ(told.count, 1);
  EXPECT_NE(told.first.find("keeps the pose 'home'"), std::string::npos);
  const auto [large_low, large_high] = extent(World(posed("home", 2 * natural)));
  EXPECT_NEAR((large_high - 2 * high).norm(), 0, 1e-6) << large_high.transpose();
  auto s = posed("sit", natural);
  s.actors[0].source = {"test.yaml", 9};
  expect_refused(s, "test.yaml", 9, {"'sit'", "zero, d/home"});
  expect_refused(posed("", natural), folder_ / "dog.xml", 3, {"an actor is one rigid body"});
}

TEST_F(OwnActor, KeepsAPoseWhateverDefaultsItsJointsHave) {
  for (const char* defaults :
       {"range='-1.5 1.5'", "limited='true' range='-1 2'", "actuatorfrcrange='-3 3'", "ref='.5'",
        "type='ball'", "springdamper='.1 1'", "stiffness='7' springref='.3'", "pos='1 2 3'",
        "armature='1' frictionloss='2' damping='3' margin='.1' group='5' user='4'"}) {
    write("dog.xml",
          "<mujoco><compiler angle='radian'/><default><joint " + std::string(defaults) +
              "/></default><worldbody><body name='trunk' pos='0 0 1'><freejoint/><geom "
              "type='box' size='.1 .1 .1'/></body></worldbody><keyframe><key name='home' "
              "qpos='0 .2 .8 1 0 0 0'/></keyframe></mujoco>");
    auto s = on_floor();
    s.actors = {
        own_actor("truck", file({.asset = "<asset><model name='dog' file='dog.xml'/></asset>",
                                 .inside = "<attach model='dog' body='trunk' prefix='d/'/>"}))};
    s.actors[0].pose = "home";
    s.actors[0].size_m = {1, .5, 1};
    const World world(s);
    const auto [low, high] = extent(world);
    EXPECT_NEAR((low - Vector3d(-.1, .1, .7)).norm(), 0, 1e-6) << defaults << low.transpose();
  }
}

TEST_F(OwnActor, WalksIfItHasTheBodiesOfAWalkerAtRestAndIsElseRefusedAtTheWrongOne) {
  const auto limbs = [](const std::string& side, const std::string& shank) {
    return "<body name='" + side + "_thigh'><joint axis='0 1 0'/><geom size='.1'/>\n<body name='" +
           side + "_shank' " + shank + "><joint axis='0 1 0'/><geom size='.1'/><body name='" +
           side + "_foot' pos='0 0 -.5'><geom size='.05'/></body></body></body><body name='" +
           side + "_upper_arm'><body name='" + side + "_forearm' pos='0 0 -.3'/></body>\n";
  };
  const auto walker = [&](const std::string& right_shank, const std::string& trunk = "trunk") {
    auto s = on_floor();
    s.actors = {own_actor("truck", file({.inside = "<body name='" + trunk + "' pos='0 0 1'>" +
                                                   limbs("left", "pos='0 0 -.5'") +
                                                   limbs("right", right_shank) + "</body>"}))};
    s.actors[0].pose = scenario::kPoseWalking;
    return s;
  };
  const fs::path truck = folder_ / "truck.xml";
  World world(walker("pos='0 0 -.5'"));
  EXPECT_EQ(world.limb_objects(), std::vector<int>(11, 1));
  EXPECT_EQ(world.warnings().of(Warning::joints_frozen).count, 0);
  expect_refused(walker("pos='0 0 -.5'", "torso"), truck, 6, {"no body 'trunk'"});
  expect_refused(walker("pos='.1 0 -.5'"), truck, 10,
                 {"right_shank", "at (0.1, 0, -0.5)", "below 0"});
  expect_refused(walker("pos='0 0 -.5' euler='0 10 0'"), truck, 10, {"right_shank", "turned"});
  auto rigid = on_floor();
  rigid.actors = {line_actor("ann", scenario::Shape::pedestrian, {4, 0}, 0, 1)};
  rigid.actors[0].pose = scenario::kPoseWalking;
  EXPECT_NE(scenario_error([&] { World of(rigid); }).find("no body 'trunk'"), std::string::npos);
}

TEST_F(OwnActor, SeveralOfOneFileStandBesideEachOtherEachInItsOwnColours) {
  const fs::path truck =
      file({.asset = "<asset><texture name='t' type='cube' builtin='flat' width='32' height='192' "
                     "rgb1='0 1 0'/><material name='paint' texture='t'/><material name='other' "
                     "texture='t'/></asset>",
            .inside = "<geom type='box' pos='0 0 .25' size='.5 .25 .25' material='paint'/>"
                      "<geom type='box' pos='0 0 .75' size='.5 .25 .25' material='other'/>"});
  const auto picture = [&](const std::string& name, const cv::Vec3b& bgr) {
    lcs::test::write_picture(folder_ / name, cv::Mat3b(8, 8, bgr));
    return (folder_ / name).string();
  };
  auto s = on_floor();
  s.scene = scenario_in_mjcf(floor_with("<light directional='true' dir='1 0 0' "
                                        "castshadow='false'/>"),
                             0.5, 1)
                .scene;
  s.actors = {own_actor("blue", truck), own_actor("red", truck), own_actor("plain", truck)};
  for (int i = 0; i < 3; ++i) {
    auto& line = std::get<scenario::Line>(s.actors[static_cast<std::size_t>(i)].trajectory);
    line.from_m = Vector2d(4, 1.2 * (1 - i));
  }
  s.actors[0].texture = picture("blue.png", {255, 0, 0});
  s.actors[1].texture = picture("red.png", {0, 0, 255});
  const Observation o = Simulation(s).next().value();
  ASSERT_EQ(o.objects.size(), 3u);
  const auto dominant = [&](const ObjectTruth& box, double down) {
    const cv::Vec3b c = o.image(static_cast<int>(box.top + down * (box.bottom - box.top)),
                                static_cast<int>((box.left + box.right) / 2));
    return std::max_element(c.val, c.val + 3) - c.val;
  };
  for (int i = 0; i < 3; ++i) {
    const ObjectTruth& box = o.objects.at(static_cast<std::size_t>(i));
    EXPECT_EQ(dominant(box, 0.75), i == 0 ? 0 : i == 1 ? 2 : 1);
    EXPECT_EQ(dominant(box, 0.25), 1) << "the material beside 'paint' stays as it is";
  }
}

TEST_F(OwnActor, SeveralOfAShippedShapeHaveSizesAndTexturesOfTheirOwn) {
  auto s = on_floor();
  for (const char* texture : {"bricks", "crate", ""}) {
    const std::string name = std::string("box") + std::to_string(s.actors.size());
    s.actors.push_back(line_actor(name, scenario::Shape::box,
                                  {4, 1.5 * static_cast<double>(s.actors.size()) - 1.5}, 0, 0));
    s.actors.back().texture = texture;
    s.actors.back().size_m = Vector3d::Constant(0.3 + 0.2 * static_cast<double>(s.actors.size()));
  }
  EXPECT_EQ(World(s).objects().size(), 3u);
}

TEST_F(OwnActor, HasNoContactsWhateverItsFileSays) {
  auto s = on_floor();
  s.actors = {own_actor("truck", file({.top = "<default><geom contype='1'/></default>"}))};
  const World world(s);
  for (int geom = 0; geom < world.model().m().ngeom; ++geom) {
    if (world.object_of_geom(geom) != 1) continue;
    EXPECT_EQ(world.model().m().geom_contype[geom] | world.model().m().geom_conaffinity[geom], 0);
  }
}

TEST_F(OwnActor, IsRefusedWhereItBreaksTheContractNamingFileLineAndRemedy) {
  expect({.base = "<body name='truck'>"}, 6, {"no body called 'base'", "<body name=\"base\">"});
  expect({.beside = "<geom name='floor' type='plane' size='1 1 1'/>"}, 5,
         {"<geom name=\"floor\">", "beside the one body 'base'", "move it into 'base'"});
  expect({.base = "<body name='base' pos='0 0 1'>"}, 6, {"place or rotation", "take it away"});
  expect({.base = "<body name='base' euler='0 0 90'>"}, 6, {"place or rotation"});
  expect({.size = ""}, 6, {"natural size", "<numeric name=\"size\""});
  expect({.size = "<custom><numeric name='size' data='1 1'/></custom>"}, 3, {"'1 1'", "in m"});
  expect({.size = "<custom><numeric name='size' data='1 0 1'/></custom>"}, 3, {"natural size"});
  expect({.inside = "<joint name='lift'/><geom size='.1'/>"}, 7,
         {"<joint name=\"lift\">", "one rigid body", "take the joint away",
          "or give the actor a pose"});
  // MuJoCo tells no line of a <freejoint>: the line is its body's
  expect({.inside = "<freejoint/><geom size='.1'/>"}, 6, {"rigid"});
  expect({.inside = "<geom type='plane' size='1 1 1'/>"}, 7, {"a plane", "use a box"});
  expect({.inside = ""}, 6, {"no geom", "give it one"});
  expect({}, 1, {"actor 'truck'", "'bricks'", "material 'paint'", "<material name=\"paint\""},
         "bricks");
  expect({.asset = "<asset><material name='paint' rgba='1 0 0 1'/></asset>"}, 4, {"'paint'"},
         "bricks");
}

TEST_F(OwnActor, IsRefusedByMujocoAtItsOwnFileAndLine) {
  expect({.inside = "<geom type='box' size='1'/>"}, 7, {"MuJoCo refuses <geom>", "size"});
  expect({.inside = "<geom size='.1' material='gold'/>"}, 7, {"gold", "define it"});
  expect({.inside = "<geom size='.1' colour='red'/>"}, 7, {"'colour'", "spelling"});
  expect({.asset = "<asset><mesh name='m' file='gone.obj'/></asset>"}, 4,
         {(folder_ / "gone.obj").string(), "missing"});
  expect({.asset = "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 1 1 0'/></asset>",
          .inside = "<geom type='mesh' mesh='m'/>"},
         4, {"coplanar", "thickness"});
  expect({.asset = "<asset><texture name='procedural:brocks' type='cube' builtin='flat' width='8' "
                   "height='48'/></asset>"},
         4, {"brocks", "bricks"});
  auto s = on_floor();
  s.actors = {own_actor("truck", write("truck.xml", "<mujoco>\n<worldbody>\n</mujoco>"))};
  expect_refused(s, folder_ / "truck.xml", 2, {"XML"});
}

// ---- Rovers

class OwnRover : public OwnPart {
 protected:
  struct Parts {
    // on lines 2, 4, 6 and 8
    std::string base = "<body name='base'>";
    std::string joints = kJoints;
    std::string inside = kInside;
    std::string actuator = kActuators;
  };
  static constexpr const char* kJoints =
      "<joint name='x' type='slide' axis='1 0 0'/><joint name='y' type='slide' axis='0 1 0'/>"
      "<joint name='yaw' axis='0 0 1'/>";
  static constexpr const char* kInside =
      "<geom type='box' size='.2 .1 .1' pos='0 0 .1' mass='8'/><site name='imu' pos='0 0 .2'/>";
  static constexpr const char* kActuators =
      "<velocity name='x' joint='x' kv='2000'/><velocity name='y' joint='y' kv='2000'/>"
      "<velocity name='yaw' joint='yaw' kv='50'/>";
  static constexpr const char* kWheels =
      "<geom type='box' size='.2 .1 .05' pos='0 0 .12' mass='8' contype='0' conaffinity='0'/>"
      "<geom size='.03' pos='.17 0 .03' condim='1' friction='0 0 0' priority='1'/>"
      "<geom size='.03' pos='-.17 0 .03' condim='1' friction='0 0 0' priority='1'/>"
      "<site name='imu' pos='0 0 .2'/>"
      "<body name='left_wheel' pos='0 .2 .12'><joint name='left' axis='0 1 0' armature='.01'/>"
      "<geom type='ellipsoid' size='.12 .03 .12' mass='.5'/></body>"
      "<body name='right_wheel' pos='0 -.2 .12'><joint name='right' axis='0 1 0' armature='.01'/>"
      "<geom type='ellipsoid' size='.12 .03 .12' mass='.5'/></body>";
  static constexpr const char* kWheelActuators =
      "<velocity name='left' joint='left' kv='2'/><velocity name='right' joint='right' kv='2'/>";
  static Parts wheeled() {
    return {.joints = "<freejoint name='base'/>", .inside = kWheels, .actuator = kWheelActuators};
  }
  static Parts with(Parts parts, const std::string& from, const std::string& to) {
    for (std::string* text : {&parts.base, &parts.joints, &parts.inside, &parts.actuator}) {
      const std::size_t at = text->find(from);
      if (at != std::string::npos) text->replace(at, from.size(), to);
    }
    return parts;
  }

  scenario::Scenario scenario(const Parts& p) const {
    auto s = on_floor();
    s.ego.drive = scenario::Drive::own;
    s.ego.drive_file = write("rover.xml", "<mujoco><worldbody>\n" + p.base + "\n\n" + p.joints +
                                              "\n\n" + p.inside + "</body></worldbody><actuator>" +
                                              "\n\n" + p.actuator + "</actuator></mujoco>");
    return s;
  }
  void expect(const Parts& parts, int line, const std::vector<std::string>& words) const {
    expect_refused(scenario(parts), folder_ / "rover.xml", line, words);
  }
  /// Pose after two seconds.
  static Pose driven(const scenario::Scenario& s) {
    World world(s);
    std::vector<ImuSample> imu;
    std::vector<OdometrySample> odometry;
    world.advance_to(2 * kSecond, imu, odometry);
    EXPECT_EQ(imu.size(), 401u);
    return world.T_WB();
  }
};

TEST_F(OwnRover, FollowsAnyCommandWhereItHasTheActuatorsForIt) {
  auto s = scenario({});
  s.ego.start_m = {1, 2};
  s.ego.heading_rad = 0.5;
  s.ego.phases = {{.speed_mps = 0.5, .direction_rad = 1}};
  const Vector2d expected = Vector2d(1, 2) + Vector2d(std::cos(1.5), std::sin(1.5));
  EXPECT_NEAR((driven(s).p.head<2>() - expected).norm(), 0, 1e-3);
}

TEST_F(OwnRover, IsNotBrakedByTheFloorThatItsFileLetsItTouch) {
  const auto s = scenario({.inside = "<geom type='box' size='.2 .1 .1' pos='0 0 .05' mass='8'/>"
                                     "<site name='imu' pos='0 0 .2'/>"});
  EXPECT_NEAR((driven(s).p - Vector3d(1, 0, 0)).norm(), 0, 1e-3);
}

TEST_F(OwnRover, DrivesOnWheelsWhereItHasTheActuatorsForThem) {
  auto s = scenario(wheeled());
  EXPECT_NEAR(driven(s).p.x(), 1, 0.06) << "a twentieth is slip";
  // also where what is seen of a wheel comes before what rolls
  const Parts seen = with(wheeled(), "<geom type='ellipsoid'",
                          "<geom type='box' size='.1 .02 .1' mass='0' contype='0' conaffinity='0'/>"
                          "<geom type='ellipsoid'");
  EXPECT_NEAR(driven(scenario(seen)).p.x(), 1, 0.06);
  // also with gears
  auto geared = wheeled();
  for (const char* side : {"left", "right"}) {
    const std::string joint = "joint='" + std::string(side) + "' ";
    geared = with(geared, joint + "kv='2'", joint + "gear='3' kv='.3'");
  }
  EXPECT_NEAR(driven(scenario(geared)).p.x(), 1, 0.06);
  // also in a scene whose geoms have no contacts by default
  std::string mjcf = floor_with("");
  mjcf.insert(mjcf.find("<statistic"), "<default><geom contype='0' conaffinity='0'/></default>");
  mjcf.insert(mjcf.find("type=\"plane\""), "contype='1' conaffinity='1' ");
  s.scene = scenario_in_mjcf(mjcf, 0.5, 1).scene;
  EXPECT_NEAR(driven(s).p.x(), 1, 0.06);
  s.ego.phases[0].direction_rad = 1;
  EXPECT_NE(scenario_error([&] { World world(s); }).find("cannot drive sideways"),
            std::string::npos);
}

/// Light wheels with a stiff motor: Euler's steps of 2 ms are unstable.
TEST_F(OwnRover, HasTheIntegratorOfItsFile) {
  auto parts = wheeled();
  for (const char* side : {"left", "right"}) {
    const std::string name = side;
    parts = with(parts, "<joint name='" + name + "' axis='0 1 0' armature='.01'/>",
                 "<joint name='" + name + "' axis='0 1 0'/>");
    parts = with(parts, "joint='" + name + "' kv='2'", "joint='" + name + "' kv='200'");
  }
  const auto stiff = scenario(parts);
  EXPECT_THROW(driven(stiff), PhysicsError);
  std::string mjcf = lcs::test::read(stiff.ego.drive_file);
  mjcf.insert(mjcf.find("<worldbody>"), "<option integrator='implicitfast' timestep='.02'/>");
  write("rover.xml", mjcf);
  EXPECT_NEAR(driven(stiff).p.x(), 1, 0.06);
}

TEST_F(OwnRover, DrivesOnFourWheelsWithAnArmOnTop) {
  std::string wheels =
      "<geom type='box' size='.2 .1 .05' pos='0 0 .15' mass='8' contype='0' "
      "conaffinity='0'/><site name='imu' pos='0 0 .2'/>"
      "<body pos='0 0 .2'><joint name='arm' axis='0 1 0' damping='1'/><geom "
      "type='box' size='.02 .02 .1' pos='0 0 .1' mass='.2'/></body>";
  std::string actuators = "<position name='arm' joint='arm' kp='20'/>";
  for (const char* side : {"left", "right"}) {
    for (const char* end : {"front", "rear"}) {
      const std::string name = std::string(side) + "_" + end;
      const std::string place = std::string(end == std::string("front") ? ".06 " : "-.06 ") +
                                (side == std::string("left") ? ".2" : "-.2");
      wheels += "<body pos='" + place + " .12'><joint name='" + name +
                "' axis='0 1 0' armature='.01'/><geom type='ellipsoid' size='.12 .03 .12' "
                "mass='.5'/></body>";
      actuators += "<velocity name='" + name + "' joint='" + name + "' kv='2'/>";
    }
  }
  auto s =
      scenario({.joints = "<freejoint name='base'/>", .inside = wheels, .actuator = actuators});
  EXPECT_NEAR(driven(s).p.x(), 1, 0.06);
  s.ego.phases[0].yaw_rate_radps = 0.3;
  const Pose turned = driven(s);
  const double heading = std::atan2(turned.R(1, 0), turned.R(0, 0));
  EXPECT_GT(heading, 0.1) << "its wheels scrub, so that it turns less than the 0.6 rad asked for";
  EXPECT_LT(heading, 0.65);
  // told: the arm's motor holds nothing; a pose makes the arm a part of the base
  EXPECT_EQ(World(s).warnings().of(Warning::joints_loose).count, 1);
  s.ego.pose = scenario::kPoseZero;
  s.ego.phases[0].yaw_rate_radps = 0;
  EXPECT_NEAR(driven(s).p.x(), 1, 0.06);
  const World posed(s);
  EXPECT_EQ(posed.warnings().of(Warning::joints_loose).count, 0);
  EXPECT_EQ(posed.warnings().of(Warning::joints_frozen).count, 1);
  EXPECT_FALSE(posed.model().has(mjOBJ_JOINT, "ego/arm"));
  EXPECT_TRUE(posed.model().has(mjOBJ_JOINT, "ego/left_rear"));
  s.ego.pose = "folded";
  s.ego.source = {"test.yaml", 9};
  expect_refused(s, "test.yaml", 9, {"the rover has the pose 'folded'", "one of zero"});
}

TEST_F(OwnRover, MayHaveACameraOfItsOwnForAViewer) {
  auto parts = Parts{};
  parts.inside += "<camera name='camera' pos='0 0 9'/>";
  auto s = scenario(parts);
  EXPECT_EQ(World(s).snapshot().T_WC.p.z(), 0.45);
}

TEST_F(OwnRover, IsRefusedWhereItBreaksTheContractNamingFileLineAndRemedy) {
  expect({.base = "<body name='hull'>"}, 2, {"no body called 'base'"});
  expect({.base = "<body name='base' pos='0 0 .1'>"}, 2, {"place or rotation"});
  expect(with({}, "<site name='imu' pos='0 0 .2'/>", ""), 2, {"no site called 'imu'", "<site"});
  expect({.actuator = ""}, 2, {"has none", "x, y and yaw", "left and right"});
  expect(with({}, "<velocity name='yaw' joint='yaw' kv='50'/>", ""), 8, {"it has x, y;"});
  expect({.actuator = std::string(kActuators) + kWheelActuators}, 8, {"'left'", "no joint"});
  expect(with({}, "<velocity name='y' joint='y'", "<velocity name='y' joint='x'"), 8,
         {"the actuator 'y'", "<velocity name=\"y\" joint=\"y\""});
  expect(with({}, "<velocity name='x' joint='x' kv='2000'/>", "<motor name='x' joint='x'/>"), 8,
         {"the actuator 'x'", "a velocity"});
  expect(with({}, "axis='0 1 0'", "axis='1 0 0'"), 4, {"<joint name=\"y\">", "the axis 0 1 0"});
  expect({.joints = "<joint name='yaw'/><joint name='x' type='slide' axis='1 0 0'/><joint name='y' "
                    "type='slide' axis='0 1 0'/>"},
         2, {"yaw, x, y", "in this order"});

  expect(with(wheeled(), "<freejoint name='base'/>", "<freejoint/>"), 2,
         {"<freejoint name=\"base\"/>"});
  expect(with(wheeled(), "pos='0 .2 .12'", "pos='.1 .2 .12'"), 6,
         {"wheels are at (0.1, 0.2)", "(0, y)"});
  expect(with(wheeled(), "size='.12 .03 .12'", "size='.1 .03 .1'"), 6,
         {"a radius of 0.12 m", "0.1 m", "the same"});
  expect(with(wheeled(), "name='left' axis='0 1 0'", "name='left' axis='0 1 0' pos='.1 0 0'"), 6,
         {"<joint name=\"left\">", "through the origin of its body"});
  expect(with(wheeled(), "name='left' axis='0 1 0'", "name='left' axis='1 0 0'"), 6,
         {"<joint name=\"left\">", "the axis 0 1 0"});
  expect(with(wheeled(), "type='ellipsoid' size='.12 .03 .12'", "type='box' size='.1 .1 .1'"), 6,
         {"wheel of 'left'", "no sphere"});
  expect(with(with(wheeled(), "<site name='imu' pos='0 0 .2'/>", ""), "armature='.01'/>",
              "/><site name='imu'/>"),
         6, {"in a body that moves"});
}

TEST_F(OwnRover, IsRefusedByMujocoAtItsOwnFileAndLine) {
  expect(with({}, "mass='8'", "mass='8' colour='red'"), 6, {"'colour'", "spelling"});
  expect(with({}, "<geom type='box' size='.2 .1 .1' pos='0 0 .1' mass='8'/>", ""), 2,
         {"mass and inertia"});
}

TEST_F(OwnRover, OnWheelsCannotBeAtPlacesAtTimes) {
  auto s = scenario(wheeled());
  s.ego.source = {"test.yaml", 3};
  s.ego.waypoints = {{0, {0, 0}}, {1, {1, 0}}};
  const std::string message = scenario_error([&] { World world(s); });
  EXPECT_EQ(message.find("test.yaml:3: a wheeled rover"), 0u) << message;
  EXPECT_NE(message.find("ego.waypoints"), std::string::npos) << message;
}

}  // namespace
}  // namespace lcs::sim
