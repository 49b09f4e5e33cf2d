// Parts without truth are not drawn; a picture that showed them would be found by the self-check.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "sim/camera/linear_light.h"
#include "sim/simulation.h"
#include "sim/world/world.h"
#include "tests/benchmark/raw_renderer.h"
#include "tests/sim/support.h"
#include "tools/sequence/self_check.h"
#include "tools/sequence/true_flow.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

using sim::test::kDegree;

constexpr int kFrame = 5;

/// A hall whose floor and back wall have textures.
struct Parts {
  const char* world = "";   ///< elements of the worldbody
  const char* others = "";  ///< sections beside it
};

scenario::Scenario hall(const Parts& parts) {
  scenario::Scenario s = sim::test::scenario_in_mjcf(fmt::format(R"(<mujoco>
  <statistic extent="8"/>
  <visual><headlight ambient=".7 .7 .7" diffuse="0 0 0" specular="0 0 0"/></visual>
  <asset>
    <texture name="procedural:rects:wall" type="cube" builtin="flat" width="512" height="3072"/>
    <texture name="procedural:ground:floor" type="2d" builtin="flat" width="512" height="512"/>
    <material name="wall" texture="procedural:rects:wall" specular="0"/>
    <material name="floor" texture="procedural:ground:floor" texrepeat=".5 .5" texuniform="true"
      specular="0"/>
    <material name="glass" rgba=".8 .9 1 .15" specular="0"/>
  </asset>
  <worldbody>
    <geom name="floor" type="plane" size="10 10 .1" material="floor"/>
    <geom name="back" type="box" size=".1 4 1.5" pos="5 0 1.5" material="wall"/>
    {}
  </worldbody>
  {}
</mujoco>)",
                                                                 parts.world, parts.others),
                                                     0.4, kFrame + 2);
  s.camera.width_px = 320;
  s.camera.height_px = 240;
  return s;
}

scenario::Actor moved_body(const std::string& body) {
  scenario::Actor actor =
      sim::test::line_actor(body, scenario::Shape::box, {2, -0.5}, 90 * kDegree, 0.6);
  actor.body = body;
  return actor;
}

/// The light of the picture that MuJoCo draws by default at a frame.
cv::Mat3f drawn_by_default(const scenario::Scenario& scenario, int frame) {
  sim::World world(scenario);
  std::vector<sim::ImuSample> imu;
  std::vector<sim::OdometrySample> odometry;
  world.advance_to(sim::event_time_ns(frame, scenario.camera.rate_hz), imu, odometry);
  world.model().m().opt.disableflags &= ~mjDSBL_SENSOR;  // MuJoCo draws the rays from the readings
  mj_forward(&world.model().m(), &world.model().d());
  test::RawRenderer renderer(world, {scenario.camera.width_px, scenario.camera.height_px}, {});
  renderer.render();
  return sim::to_linear(renderer.picture());
}

/// Runs the check on two frames of a scenario: as they are, and as MuJoCo draws them by default.
void expect_only_default_pictures_to_fail(const scenario::Scenario& scenario) {
  sim::Simulation simulation(scenario);
  for (int k = 0; k < kFrame; ++k) simulation.skip();
  sim::Observation now = *simulation.next(), next = *simulation.next();
  const TrueFlow flow = true_flow(simulation.calibration().camera, now.truth, now.geom,
                                  {next.truth.depth_m, next.geom});
  EXPECT_LT(check_picture(now, next, flow).worst, 0.05);
  now.rendered = drawn_by_default(scenario, kFrame);
  next.rendered = drawn_by_default(scenario, kFrame + 1);
  EXPECT_THROW(check_picture(now, next, flow), TruthError);
}

TEST(DrawnParts, AMoverBehindAPaneOfGlassIsFoundInThePicture) {
  scenario::Scenario s =
      hall({.world = R"(<geom type="box" size=".01 1.2 1.2" pos="1.5 0 1.2" material="glass"/>)"});
  s.actors = {
      sim::test::line_actor("walker", scenario::Shape::pedestrian, {3, -0.6}, 90 * kDegree, 0.8)};
  expect_only_default_pictures_to_fail(s);
}

TEST(DrawnParts, APaneOfGlassThatMovesBeforeAWallIsFoundInThePicture) {
  scenario::Scenario s = hall({.world = R"(<body name="door" pos="2 -.5 0">
    <geom type="box" size=".01 .5 1" pos="0 0 1" material="glass"/></body>)"});
  s.actors = {moved_body("door")};
  expect_only_default_pictures_to_fail(s);
}

/// Drives aside, so that near and far parts move apart in the picture.
scenario::Scenario drives_aside(scenario::Scenario scenario) {
  scenario.ego.phases.front().direction_rad = 90 * kDegree;
  return scenario;
}

TEST(DrawnParts, RaysOfARangeFinderAreFoundInThePicture) {
  expect_only_default_pictures_to_fail(drives_aside(
      hall({.world = R"(<body name="post" pos="1.2 .5 0"><geom type="box" size=".02 .02 .2"/>
        <site name="eye" pos="0 -.05 .4" zaxis=".8 -.4 .5"/></body>)",
            .others = R"(<sensor><rangefinder site="eye"/></sensor>)"})));
}

TEST(DrawnParts, ARopeIsFoundInThePicture) {
  expect_only_default_pictures_to_fail(drives_aside(
      hall({.world = R"(<site name="low" pos="1.5 .3 .1"/><site name="high" pos="1.5 .2 1.5"/>)",
            .others = R"(<tendon><spatial name="rope" width=".02" rgba="1 1 0 1">
              <site site="low"/><site site="high"/></spatial></tendon>)"})));
}

TEST(DrawnParts, ASkinIsFoundInThePicture) {
  scenario::Scenario s =
      hall({.world = R"(<body name="pole" pos="2 -.5 0"><geom type="cylinder" size=".05 .7"
        pos="0 0 .7"/></body>)",
            .others = R"(<asset><skin name="banner" material="wall"
        vertex="0 -.6 .2  0 .6 .2  0 .6 1.4  0 -.6 1.4" face="0 2 1  0 3 2  0 1 2  0 2 3">
        <bone body="pole" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2 3"
          vertweight="1 1 1 1"/></skin></asset>)"});
  s.actors = {moved_body("pole")};
  expect_only_default_pictures_to_fail(s);
}

}  // namespace
}  // namespace lcs::sequence
