/// Warnings of the watch over a world, and no warnings in a correct world.
#include "sim/world/watch.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "sim/simulation.h"
#include "sim/world/world.h"
#include "tests/sim/support.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::sim {
namespace {

using scenario::Shape;
using test::floor_with;
using test::line_actor;
using test::scenario_error;
using test::scenario_in_mjcf;

constexpr const char* kCrate =
    "<body name='crate' pos='2 0 .3'><geom type='box' size='.3 .3 .3'/></body>";

/// Warnings of a drive to the last frame.
Warnings driven(const scenario::Scenario& scenario) {
  World world(scenario);
  std::vector<ImuSample> imu;
  std::vector<OdometrySample> odometry;
  world.advance_to(event_time_ns(scenario.frames, scenario.camera.rate_hz), imu, odometry);
  return world.warnings();
}

std::vector<std::int64_t> counts(const Warnings& warnings) {
  std::vector<std::int64_t> all;
  for (std::size_t i = 0; i < kWarnings.size(); ++i) {
    all.push_back(warnings.of(static_cast<Warning>(i)).count);
  }
  return all;
}

const std::vector<std::int64_t> kNone(kWarnings.size(), 0);

void expect_told(const Warnings& warnings, Warning warning, const std::string& part) {
  EXPECT_EQ(warnings.of(warning).count, 1);
  EXPECT_NE(warnings.of(warning).first.find(part), std::string::npos) << warnings.of(warning).first;
}

TEST(Watch, TellsOnceWhatTheRoverRunsIntoWithTimeAndPlace) {
  // its hull is .2 m long to either side: 1.5 m to the crate's side, and 2 cm, at 1 m/s
  const Warnings warnings = driven(scenario_in_mjcf(floor_with(kCrate), 1, 40));
  expect_told(warnings, Warning::rover_collisions, "the rover runs into object 'crate' at 1.5");
  EXPECT_EQ(warnings.of(Warning::actor_collisions).count, 0);
}

TEST(Watch, TellsNothingOfWhatIsOnlyPassed) {
  auto scenario = scenario_in_mjcf(floor_with(kCrate), 1, 40);
  scenario.ego.start_m = {0, .5};  // 5 cm beside it
  EXPECT_EQ(counts(driven(scenario)), kNone);
}

TEST(Watch, TellsWhatAWallWasDrivenThroughAtAnySpeedAndRate) {
  const std::string walls =
      "<geom name='thin' type='box' pos='3 0 1' size='.005 2 1'/>"
      "<geom name='sheet' type='plane' pos='6 0 1' zaxis='-1 0 0' size='1 2 .1'/>"
      "<geom name='beside' type='plane' pos='8 9 1' zaxis='-1 0 0' size='1 2 .1'/>";
  auto scenario = scenario_in_mjcf(floor_with(walls), 5, 3);
  scenario.camera.rate_hz = 1;
  scenario.imu.rate_hz = 1;
  const Warnings warnings = driven(scenario);
  EXPECT_EQ(warnings.of(Warning::rover_collisions).count, 2);
  EXPECT_NE(warnings.of(Warning::rover_collisions).first.find("'thin'"), std::string::npos);
}

TEST(Watch, TellsActorsThatPassThroughThingsAndTheRover) {
  auto scenario = scenario_in_mjcf(floor_with(kCrate), 0, 40);
  scenario.actors = {line_actor("walker", Shape::pedestrian, {2, -2}, 90 * test::kDegree, 1),
                     line_actor("car", Shape::car, {-4, 0}, 0, 2)};
  const Warnings warnings = driven(scenario);
  expect_told(warnings, Warning::rover_collisions, "the rover runs into actor 'car'");
  EXPECT_EQ(warnings.of(Warning::actor_collisions).count, 3);  // walker, car; crate
  EXPECT_NE(warnings.of(Warning::actor_collisions).first.find("object 'crate'"), std::string::npos);
}

TEST(Watch, TellsAnActorThatPassesThroughAWallThatIsAPlane) {
  auto scenario = scenario_in_mjcf(
      floor_with("<geom name='wall' type='plane' pos='0 3 1' zaxis='0 -1 0' size='9 1 .1'/>"), 0,
      40);
  scenario.actors = {line_actor("walker", Shape::pedestrian, {2, 1}, 90 * test::kDegree, 1)};
  expect_told(driven(scenario), Warning::actor_collisions,
              "actor 'walker' passes through the setting's geom 'wall' at 1.");
}

TEST(Watch, ActorsStepOverKerbsAndTheRoverDoesNot) {
  const std::string kerb = "<geom name='kerb' type='box' pos='1 0 .06' size='.1 3 .07'/>";
  auto scenario = scenario_in_mjcf(floor_with(kerb), 0, 30);
  scenario.actors = {line_actor("walker", Shape::pedestrian, {0, 2}, 0, 1)};
  EXPECT_EQ(counts(driven(scenario)), kNone);
  scenario.ego.phases = {{.speed_mps = 1}};
  expect_told(driven(scenario), Warning::rover_collisions, "the setting's geom 'kerb'");
}

/// A table as one mesh, a board on two boards, so that its hull is a solid block.
std::string table() {
  struct Board {
    Eigen::Vector3d low, high;
  };
  std::string vertices, faces;
  int first = 0;
  for (const Board& board :
       {Board{{-.5, -.6, .9}, {.5, .6, 1}}, Board{{-.5, -.6, 0}, {.5, -.5, .89}},
        Board{{-.5, .5, 0}, {.5, .6, .89}}}) {
    for (int i = 0; i < 8; ++i) {
      vertices += fmt::format("{} {} {} ", i & 1 ? board.high.x() : board.low.x(),
                              i & 2 ? board.high.y() : board.low.y(),
                              i & 4 ? board.high.z() : board.low.z());
    }
    for (const int corner : {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                             2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5}) {
      faces += fmt::format("{} ", first + corner);
    }
    first += 8;
  }
  return fmt::format(
      "<body name='table' pos='2 0 0'><geom type='mesh' mesh='table'/></body>"
      "</worldbody><asset><mesh name='table' vertex='{}' face='{}'/></asset>"
      "<worldbody>",
      vertices, faces);
}

TEST(Watch, AMeshIsItsSurfaceAndNotItsHull) {
  EXPECT_EQ(counts(driven(scenario_in_mjcf(floor_with(table()), 1, 40))), kNone);
  auto beside = scenario_in_mjcf(floor_with(table()), 1, 40);
  beside.ego.start_m = {0, .55};  // along a board
  expect_told(driven(beside), Warning::rover_collisions, "object 'table'");
}

/// A wheeled rover at 0.5 m/s that reaches a block after 1.2 s, and pushes against it.
scenario::Scenario against_a_block(int frames) {
  auto scenario = scenario_in_mjcf(
      floor_with("<body name='block' pos='1 0 .3'><geom type='box' size='.2 .6 .3'/></body>"), .5,
      frames);
  scenario.ego.drive = scenario::Drive::wheeled;
  return scenario;
}

TEST(Watch, TellsAWheeledRoverThatPushesAgainstSomething) {
  expect_told(driven(against_a_block(40)), Warning::rover_collisions,
              "the rover runs into object 'block'");
}

TEST(Watch, TellsARoverThatDrivesOffTheFloorAndTipsOver) {
  const std::string edge = R"(<mujoco><statistic extent="10" center="0 0 0"/><worldbody>
    <geom name='deck' type='box' pos='0 0 -.5' size='1 1 .5'/></worldbody></mujoco>)";
  auto scenario = scenario_in_mjcf(edge, 1, 30);
  scenario.ego.drive = scenario::Drive::wheeled;
  const Warnings warnings = driven(scenario);
  expect_told(warnings, Warning::rover_below_ground, "the rover is below the ground at");
  EXPECT_GE(warnings.of(Warning::rover_tipped).count, 1);
}

TEST(Watch, TellsAnObjectThatFallsThroughTheFloor) {
  const std::string stone =
      "<body name='stone' pos='3 0 .4'><freejoint/>"
      "<geom size='.2' contype='0' conaffinity='0'/></body>";
  expect_told(driven(scenario_in_mjcf(floor_with(stone), 0, 20)), Warning::objects_below_ground,
              "object 'stone' is below the ground at 0.3");
}

TEST(Watch, TellsAnActorWhoseTriggerNeverFiresOrWhoseSpeedIsZero) {
  auto scenario = scenario_in_mjcf(floor_with(""), 0, 20);
  scenario.actors = {line_actor("walker", Shape::pedestrian, {6, 0}, 0, 1)};
  EXPECT_EQ(counts(driven(scenario)), kNone);
  scenario.actors.front().start.ego_within_m = 2;
  expect_told(driven(scenario), Warning::actors_never_moved, "the rover comes as near as 6.00 m");
  scenario.actors = {line_actor("walker", Shape::pedestrian, {6, 0}, 0, 0)};
  expect_told(driven(scenario), Warning::actors_never_moved, "actor 'walker' never moves");
}

TEST(Watch, TellsAnActorThatNoPictureShows) {
  auto scenario = scenario_in_mjcf(floor_with(""), 0, 3);
  scenario.camera.width_px = 64;
  scenario.camera.height_px = 48;
  scenario.actors = {line_actor("ahead", Shape::box, {4, 0}, 0, 1),
                     line_actor("behind", Shape::box, {-4, 0}, 0, 1)};
  Simulation simulation(scenario);
  for (int k = 0; k < 2; ++k) simulation.next();
  EXPECT_EQ(simulation.warnings().of(Warning::actors_never_seen).count, 0) << "not yet known";
  simulation.next();
  expect_told(simulation.warnings(), Warning::actors_never_seen,
              "actor 'behind' is in none of the 3 pictures");
}

/// An actor's file with one box of half a metre.
scenario::Actor box_in_file(double low_m, double stated_m) {
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::filesystem::path file = lcs::test::folder_of_the_process() / (test + "_box.xml");
  std::ofstream(file) << fmt::format(
      "<mujoco><custom><numeric name='size' data='{0} {0} {0}'/></custom><worldbody>"
      "<body name='base'><geom type='box' size='.25 .25 .25' pos='0 0 {1}'/></body>"
      "</worldbody></mujoco>",
      stated_m, low_m + 0.25);
  scenario::Actor actor = line_actor("crate", Shape::own, {4, 0}, 0, 0.5);
  actor.shape_file = file;
  return actor;
}

TEST(Watch, TellsAnActorInTheGround) {
  auto scenario = scenario_in_mjcf(floor_with(""), 0, 10);
  scenario.actors = {box_in_file(-0.05, 0.5)};
  EXPECT_EQ(counts(driven(scenario)), kNone);
  scenario.actors = {box_in_file(-0.6, 0.5)};
  expect_told(driven(scenario), Warning::actors_in_ground,
              "actor 'crate' reaches 0.60 m into the ground at 0.00 s");
}

TEST(Watch, TellsAnActorWhoseSizeIsNotThatOfItsGeoms) {
  auto scenario = scenario_in_mjcf(floor_with(""), 0, 10);
  scenario.actors = {box_in_file(0, 5)};
  expect_told(driven(scenario), Warning::actors_of_other_size,
              "actor 'crate' is 0.50 x 0.50 x 0.50 m large, and should be 5.00 x 5.00 x 5.00 m");
  // scaling keeps the error
  scenario.actors.front().size_m = {1, 2, 1};
  expect_told(driven(scenario), Warning::actors_of_other_size, "should be 1.00 x 2.00 x 1.00 m");
}

TEST(Watch, TellsEachSecondInWhichARoverDoesNotFollowItsCommand) {
  const Warnings warnings = driven(against_a_block(41));
  EXPECT_EQ(warnings.of(Warning::rover_off_command).count, 3);
  EXPECT_NE(warnings.of(Warning::rover_off_command)
                .first.find("from 1.0 to 2.0 s, where (0.50, 0.00) m/s and 0.0 deg/s are asked"),
            std::string::npos)
      << warnings.of(Warning::rover_off_command).first;
}

TEST(Watch, TellsTranslucentGeomsAndPartsThatAreNotDrawnAtTheirLine) {
  const std::string parts =
      "<geom name='pane' type='box' pos='4 0 1' size='.01 1 1' rgba='1 1 1 .3'/>\n"
      "<geom type='box' pos='4 3 1' size='.01 1 1' rgba='1 1 1 0'/>\n"
      "<site name='a' pos='3 0 1'/><site name='b' pos='3 1 1'/></worldbody>\n"
      "<tendon><spatial name='rope'><site site='a'/><site site='b'/></spatial></tendon><worldbody>";
  const Warnings warnings = driven(scenario_in_mjcf(floor_with(parts), 0, 2));
  expect_told(warnings, Warning::translucent_geoms, ".xml:6: a geom of body 'world' has alpha 0.3");
  expect_told(warnings, Warning::undrawn_parts, "tendon 'rope' is not drawn");
}

/// A height field is ground, however high it is: nobody is under it.
TEST(Watch, TellsOfARoverInsideAHill) {
  std::string mjcf = floor_with("<geom type='hfield' hfield='hill' pos='3 0 0'/>");
  mjcf.insert(
      mjcf.find("<worldbody>"),
      "<asset><hfield name='hill' nrow='3' ncol='3' size='2 2 2 .1' elevation='0 0 0 0 1 0 0 "
      "0 0'/></asset>");
  expect_told(driven(scenario_in_mjcf(mjcf, 1, 30)), Warning::rover_below_ground,
              "below the ground");
}

/// Two geoms and whether they are told. A box of the setting reaches to x = 3.5 m.
TEST(Watch, TellsOfSurfacesInOnePlaceThatACameraSees) {
  const std::string wall =
      "<geom name='wall' type='box' size='.5 2 1' pos='4 0 1' rgba='1 0 0 1'/>";
  const std::map<std::string, bool> cases{
      {"<body name='door' pos='3.55 0 .8'><geom type='box' size='.05 .4 .8'/></body>", true},
      {"<body name='door' pos='3.54 0 .8'><geom type='box' size='.05 .4 .8'/></body>", false},
      {"<geom type='plane' size='12 9 .05' rgba='0 1 0 1'/>", true},
      {"<geom type='plane' size='12 9 .05' pos='0 0 .001' rgba='0 1 0 1'/>", false},
      {"<geom type='plane' size='12 9 .05' rgba='.5 .5 .5 1'/>", false},  // looks as the floor
      {"<geom type='cylinder' size='.3 .05' pos='1 3 -.05' rgba='0 0 1 1'/>",
       true},  // a lid in the floor
      {"<geom type='cylinder' size='.3 .05' pos='1 3 .05'/>", false},
      {"<body name='a' pos='1 3 1'><geom size='.3'/></body><body name='b' pos='1 3 1'><geom "
       "size='.3' rgba='0 0 1 1'/></body>",
       true},
      {"<body name='a' pos='1 3 1'><geom size='.3'/><geom size='.3'/></body>", false},
      {"<geom type='box' size='.1 .1 .1' pos='3.4 0 .1'/><body name='b'><geom type='box' size='.1 "
       ".1 "
       ".2' pos='3.4 .1 .2' rgba='0 0 1 1'/></body>",
       true},  // their sides before the wall
      {"<geom type='box' size='.1 .1 .1' pos='4 2.1 .1' rgba='1 0 0 1'/>", false}};
  for (const auto& [more, is_told] : cases) {
    const auto s = scenario_in_mjcf(floor_with(wall + "\n" + more), 0, 1);
    const Warnings::Met told = World(s).warnings().of(Warning::coplanar_faces);
    EXPECT_EQ(told.count > 0, is_told) << more << told.first;
    const bool has_place = told.first.find(s.scene.string() + ":") != std::string::npos;
    EXPECT_EQ(has_place, is_told) << told.first;
  }
}

TEST(Watch, TellsOfVisibleSitesAndOfOptionsThatAreReplaced) {
  std::string mjcf = floor_with(
      "<site name='goal' type='box' size='.3 .3 .3' pos='3 .3 .3'/><site name='mark' pos='2 0 "
      "1'/>");
  mjcf.insert(mjcf.find("<statistic"),
              "<option timestep='.01' integrator='RK4'><flag "
              "actuation='disable'/></option>");
  const Warnings warnings = driven(scenario_in_mjcf(mjcf, 0, 2));
  expect_told(warnings, Warning::undrawn_parts, "site 'goal' is not drawn");
  const Warnings::Met& replaced = warnings.of(Warning::options_replaced);
  EXPECT_EQ(replaced.count, 3);
  EXPECT_NE(replaced.first.find("timestep of 10 ms is replaced by 2 ms"), std::string::npos)
      << replaced.first;
}

TEST(Watch, RoughGroundRampsAndRestingObjectsAreNothingToTell) {
  const std::string ball = "<body name='ball' pos='0 2 .2'><freejoint/><geom size='.2'/></body>";
  const std::string ramp =
      "<geom name='ramp' type='box' pos='2.5 0 0' size='1.5 1 .02' euler='0 -5 0'/>";
  auto scenario = scenario_in_mjcf(floor_with(ball), .5, 60);
  EXPECT_EQ(counts(driven(scenario)), kNone) << "though the rover has no contacts";
  scenario = scenario_in_mjcf(floor_with(ramp + ball), .5, 60);
  scenario.ego.drive = scenario::Drive::wheeled;
  EXPECT_EQ(counts(driven(scenario)), kNone);
  scenario = scenario_in_mjcf(floor_with(""), .5, 30);
  scenario.ground = scenario::RoughGround{};
  EXPECT_EQ(counts(driven(scenario)), kNone) << "holonomic";
  scenario.ego.drive = scenario::Drive::wheeled;
  EXPECT_EQ(counts(driven(scenario)), kNone);
}

TEST(Start, OfARoverInsideOfAnythingIsRefused) {
  auto scenario = scenario_in_mjcf(floor_with(kCrate), 0, 1);
  scenario.ego.start_m = {2.2, 0};
  const std::string message = scenario_error([&] { World world(scenario); });
  EXPECT_NE(message.find("ego.start: the rover starts inside object 'crate'"), std::string::npos)
      << message;
}

TEST(Start, OfAnActorInsideOfAnObjectIsRefusedAtItsLineAndAGrazeIsTold) {
  auto scenario = scenario_in_mjcf(floor_with(kCrate), 0, 1);
  scenario.actors = {line_actor("walker", Shape::pedestrian, {2, 0}, 0, 0)};
  const std::string message = scenario_error([&] { World world(scenario); });
  EXPECT_NE(message.find("test.yaml:7: actor 'walker' starts inside object 'crate'"),
            std::string::npos)
      << message;
  scenario = scenario_in_mjcf(floor_with(kCrate), 1, 3);
  scenario.actors = {line_actor("box", Shape::box, {2.5, 0}, 0, 0)};
  expect_told(driven(scenario), Warning::actor_collisions, "actor 'box' passes through object");
}

TEST(Start, OfAWheeledRoverThatNothingHoldsIsRefused) {
  const std::string floor = R"(<mujoco><statistic extent="10"/><worldbody>
    <geom name='floor' type='plane' size='5 5 .1' contype='0' conaffinity='0'/>
    </worldbody></mujoco>)";
  auto scenario = scenario_in_mjcf(floor, 1, 10);
  EXPECT_EQ(counts(driven(scenario)), kNone) << "the holonomic one has no contacts";
  scenario.ego.drive = scenario::Drive::wheeled;
  std::string message = scenario_error([&] { World world(scenario); });
  EXPECT_NE(message.find("geom 'floor' under ego.start"), std::string::npos) << message;
  EXPECT_NE(message.find("contype 0"), std::string::npos) << message;
  scenario = scenario_in_mjcf("<mujoco><worldbody/></mujoco>", 1, 10);
  scenario.ego.drive = scenario::Drive::wheeled;
  message = scenario_error([&] { World world(scenario); });
  EXPECT_NE(message.find("nothing is under ego.start"), std::string::npos) << message;
}

}  // namespace
}  // namespace lcs::sim
