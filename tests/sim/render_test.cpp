// The renderer against rays cast through the model without GL.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sim/camera/lens_renderer.h"
#include "sim/camera/linear_light.h"
#include "sim/world/world.h"
#include "tests/sim/support.h"
#include "tests/tools/refusal.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::floor_with;
using test::line_actor;
using test::scenario_in;
using test::scenario_in_mjcf;

constexpr double kNone = std::numeric_limits<double>::infinity();

struct Hit {
  double depth_m = kNone;
  int geom = -1;
};

/// Casts the ray of a pixel. Directions have z-depth 1, so the distance is the z-depth.
Hit cast(const World& world, const Pinhole& camera, int x, int y) {
  const Pose T_WC = world.snapshot().T_WC;
  const Vector3d direction = T_WC.R * camera.back_project({x, y}, 1);
  const int rover = world.model().id(mjOBJ_BODY, kEgoBody);
  Hit hit;
  const double distance = mj::ray(world.model().m(), world.model().d(), T_WC.p.data(),
                                  direction.data(), rover, hit.geom);
  if (hit.geom >= 0) hit.depth_m = distance;
  return hit;
}

struct Agreement {
  int pixels = 0, same_geom = 0, hits = 0, same_depth = 0;
};

/// Compares every seventh pixel of every fifth row.
Agreement compare(const scenario::Scenario& s) {
  World world(s);
  const Pinhole camera = test::pinhole_of(s.camera);
  LensRenderer renderer(world.model(), world.camera_id(), camera);
  renderer.update();
  cv::Mat1f depth;
  cv::Mat1i geom;
  renderer.render_depth_and_geoms(depth, geom);
  Agreement a;
  for (int y = 2; y < camera.height_px; y += 5) {
    for (int x = 3; x < camera.width_px; x += 7) {
      const Hit hit = cast(world, camera, x, y);
      ++a.pixels;
      if (hit.geom != geom(y, x)) continue;
      ++a.same_geom;
      if (hit.geom < 0) continue;
      ++a.hits;
      a.same_depth += std::abs(depth(y, x) - hit.depth_m) <= 0.01 * hit.depth_m;
    }
  }
  return a;
}

void expect_agreement(const Agreement& a) {
  // rays and GL may differ on pixels that an edge crosses: 0.5 % are allowed
  EXPECT_GE(a.same_geom, 0.995 * a.pixels);
  // and where both hit the same geom, the depths agree
  EXPECT_EQ(a.same_depth, a.hits);
  EXPECT_GT(a.hits, a.pixels / 2) << "a view of something";
  testing::Test::RecordProperty("pixels", a.pixels);
  testing::Test::RecordProperty("same_geom", a.same_geom);
}

TEST(Render, DepthAndGeomsOfTheLabAgreeWithRays) {
  auto s = scenario_in("lab", 0.5, 1);
  s.actors = {line_actor("walker", scenario::Shape::pedestrian, {1, 0.5}, 2, 0.5)};
  expect_agreement(compare(s));
}

TEST(Render, DepthAndGeomsOfTheStreetAgreeWithRays) {
  auto s = scenario_in("street", 1, 1);
  s.ego.start_m = {-9, 0};
  s.camera.width_px = 1280;
  s.camera.height_px = 960;
  s.actors = {line_actor("other", scenario::Shape::car, {9, 0.3}, 3, 1)};
  expect_agreement(compare(s));
}

TEST(Render, AgreesWithRaysForACameraThatIsTiltedAndMountedAside) {
  auto s = scenario_in("lab", 0.5, 1);
  s.ego.heading_rad = 0.3;
  s.camera.mount_position_m = {0.1, 0.2, 0.9};
  s.camera.mount_rpy_rad = {0.2, 0.25, -0.4};
  s.camera.fovy_rad = 90 * test::kDegree;
  s.camera.width_px = 320;
  s.camera.height_px = 400;
  expect_agreement(compare(s));
}

/// Centroid of the pixels of a mask.
Vector2d centroid(const cv::Mat1b& mask) {
  const cv::Moments m = cv::moments(mask, true);
  return {m.m10 / m.m00, m.m01 / m.m00};
}

/// The colour before the lens and the geoms of a world's first frame.
struct Drawn {
  cv::Mat3f colour;
  cv::Mat1i geom;

  explicit Drawn(const scenario::Scenario& s) {
    Simulation simulation(s);
    const Observation o = *simulation.next();
    colour = o.rendered;
    geom = o.geom;
  }
  bool operator==(const Drawn& other) const {
    return cv::norm(colour, other.colour, cv::NORM_INF) == 0 &&
           cv::norm(geom, other.geom, cv::NORM_INF) == 0;
  }
};

scenario::Scenario wall_and_pane(const std::string& pane) {
  return scenario_in_mjcf(
      floor_with("<geom type='box' pos='6 0 1' size='.1 3 3' rgba='1 .2 .2 1'/>" + pane), 0, 1);
}

TEST(Render, TranslucentGeomsAreDrawnOpaque) {
  const auto with_alpha = [](double alpha) {
    return Drawn(wall_and_pane(
        fmt::format("<geom type='box' pos='3 0 1' size='.1 1 1' rgba='.2 .2 1 {}'/>", alpha)));
  };
  EXPECT_TRUE(with_alpha(0.2) == with_alpha(1));
  EXPECT_FALSE(with_alpha(0) == with_alpha(1));
}

TEST(Render, AStainOnAFixedSurfaceKeepsItsAlpha) {
  const auto stained = [](const char* place, double alpha) {
    return Drawn(wall_and_pane(
        fmt::format("<geom type='box' size='.5 .4 .001' rgba='0 0 0 {}' {}/>", alpha, place)));
  };
  const char* on_floor = "pos='3 0 .003'";
  EXPECT_FALSE(stained(on_floor, 0.4) == stained(on_floor, 1));
  const char* on_wall = "pos='5.898 0 1' euler='0 90 0'";
  EXPECT_FALSE(stained(on_wall, 0.4) == stained(on_wall, 1));
  const char* in_the_air = "pos='3 0 .05'";
  EXPECT_TRUE(stained(in_the_air, 0.4) == stained(in_the_air, 1));
  const char* mostly_over_the_edge = "pos='5.898 3.2 1' euler='0 90 0'";
  EXPECT_TRUE(stained(mostly_over_the_edge, 0.4) == stained(mostly_over_the_edge, 1));
}

TEST(Render, GeomsWithoutAlphaAreNeitherInThePictureNorInTheMask) {
  const Drawn none(wall_and_pane(""));
  const std::string glass =
      "</worldbody><asset><material name='air' rgba='0 1 0 0'/><material name='paint' "
      "rgba='0 1 0 1'/></asset><worldbody><geom type='box' pos='3 0 1' size='.1 1 1' ";
  EXPECT_TRUE(Drawn(wall_and_pane(glass + "rgba='0 1 0 0'/>")) == none);
  EXPECT_TRUE(Drawn(wall_and_pane(glass + "material='air'/>")) == none);
  EXPECT_TRUE(Drawn(wall_and_pane(glass + "material='paint' rgba='0 1 0 0'/>")) == none);
  EXPECT_FALSE(Drawn(wall_and_pane(glass + "material='paint'/>")) == none);
}

TEST(Render, DrawsTheGroupsThatTheCameraNames) {
  const std::string hull = "<geom type='box' pos='3 0 1' size='.2 1 1' group='3'/>";
  const Drawn none(wall_and_pane(""));
  EXPECT_TRUE(Drawn(wall_and_pane(hull)) == none);
  scenario::Scenario s = wall_and_pane(hull);
  s.camera.groups = {0, 3};
  EXPECT_FALSE(Drawn(s) == none);
  s.camera.groups = {3};
  const Drawn hull_alone(s);
  EXPECT_EQ(cv::countNonZero(hull_alone.geom == hull_alone.geom(0, 0)) +
                cv::countNonZero(hull_alone.geom == 2),
            hull_alone.geom.size().area())
      << "the sky and the hull";
}

TEST(Render, SitesTendonsAndRaysAreNotDrawn) {
  const std::string aids =
      "<site name='a' pos='3 .5 .5' size='.2'/><site name='b' pos='3 -.5 .5' size='.2'/>"
      "</worldbody><tendon><spatial width='.1'><site site='a'/><site site='b'/></spatial></tendon>"
      "<sensor><rangefinder site='a'/></sensor><worldbody>";
  EXPECT_TRUE(Drawn(wall_and_pane(aids)) == Drawn(wall_and_pane("")));
}

// Small balls off the centre, so that a flipped or swapped axis, or half a pixel, is detected.
TEST(Render, APointLandsOnThePixelThatThePinholeSays) {
  const std::vector<Vector3d> targets = {
      {4, 1.4, 1.2}, {5, -2.1, 0.2}, {6, 2.0, 0.1}, {3, -0.5, 1.1}};
  std::string balls;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Vector3d& p = targets[i];
    balls += "<body name='ball" + std::to_string(i) + "' pos='" + std::to_string(p.x()) + " " +
             std::to_string(p.y()) + " " + std::to_string(p.z()) +
             "'><geom type='sphere' size='.05' rgba='1 .1 .1 1'/></body>";
  }
  std::string mjcf = floor_with(balls);
  // even light, so that the centroid of a ball's colour is the ball's centre
  mjcf.insert(mjcf.find("<worldbody>"), "<visual><headlight ambient='1 1 1'/></visual>");
  mjcf.erase(mjcf.find("<light"), mjcf.find("<geom name=\"floor\"") - mjcf.find("<light"));
  Simulation simulation(scenario_in_mjcf(mjcf, 0, 1));
  const Observation o = simulation.next().value();
  const Calibration& calibration = simulation.calibration();
  const Pose T_CW = (calibration.T_WB_start * calibration.T_BC).inverse();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Vector2d expected = calibration.camera.project(T_CW * targets[i]);
    cv::Mat1b mask;
    cv::compare(o.truth.object, simulation.objects()[i].id, mask, cv::CMP_EQ);
    ASSERT_GT(cv::countNonZero(mask), 20) << "ball " << i << " is not where it is expected";
    // pixels are counted whole: the centroid of some 50 is exact to a quarter
    EXPECT_NEAR((centroid(mask) - expected).norm(), 0, 0.25) << "ball " << i;
    // the colour image matches the ids: the ball is redder than its surroundings
    std::vector<cv::Mat1b> bgr;
    cv::split(o.image, bgr);
    cv::Mat1b red;
    cv::compare(bgr[2], 2 * bgr[1] + 40, red, cv::CMP_GT);
    const cv::Rect around(static_cast<int>(expected.x()) - 12, static_cast<int>(expected.y()) - 12,
                          25, 25);
    EXPECT_NEAR((centroid(red(around)) + Vector2d(around.x, around.y) - expected).norm(), 0, 0.35)
        << "ball " << i;
  }
}

/// A white sheet 3 m before a black wall, each evenly lit, with an upright left edge `left_m` to
/// the left of the axis (right: below 0), of a picture of 64 x 48 px.
scenario::Scenario sheet(double left_m, double right_m, const std::string& white = "1 1 1 1") {
  scenario::Scenario s = scenario_in_mjcf(
      fmt::format(R"(<mujoco><statistic extent="10"/><visual><headlight ambient="1 1 1"
        diffuse="0 0 0"/></visual><worldbody><geom type="plane" size="9 9 .1" pos="0 0 -9"/>
        <geom type="box" pos="4.1 0 0" size=".1 20 20" rgba="0 0 0 1"/>
        <geom type="box" pos="3.1 {} 0" size=".1 {} 9" rgba="{}"/></worldbody></mujoco>)",
                  (left_m + right_m) / 2, (left_m - right_m) / 2, white),
      0, 1);
  s.image.samples = scenario::Image{}.samples;
  s.camera.width_px = 64;
  s.camera.height_px = 48;
  s.camera.mount_position_m = {0, 0, 0.45};
  return s;
}

/// A pixel's light is its share of the sheet, so that the light of a row is the sheet's width in
/// it: to half of the distance between two places of samples along the row.
TEST(Render, ThePixelsOfAnOutlineHaveTheShareThatTheSurfaceCovers) {
  for (const auto& [samples, places] : {std::pair{1, 1}, {4, 2}, {5, 5}, {9, 3}}) {
    double worst_px = 0;
    for (double left_m = 0.2; left_m < 0.3; left_m += 0.007) {
      scenario::Scenario s = sheet(left_m, -9);
      s.image.samples = samples;
      const double focal_px = test::pinhole_of(s.camera).focal_px;
      const Observation o = *Simulation(s).next();
      double light_px = 0;
      for (int x = 0; x < 64; ++x) light_px += o.rendered(20, x)[1];
      // from the left edge, at 31.5 - f left / z, to the right end of the picture, at 63.5
      worst_px = std::max(worst_px, std::abs(light_px - (32 + focal_px * left_m / 3)));
    }
    EXPECT_LT(worst_px, 0.5 / places + 0.01) << samples;
    EXPECT_GT(worst_px, 0.3 / places) << samples;
  }
}

/// The same for a bar, behind the lens: its point spread acts on light, which it only moves.
TEST(Render, ABarIsInLightAsWideAsItIsDrawn) {
  for (const double right_m : {-0.05, -0.11, -0.3}) {
    scenario::Scenario s = sheet(0.2, right_m, ".4 .4 .4 1");
    s.image.noise.reset();
    const double focal_px = test::pinhole_of(s.camera).focal_px;
    const cv::Mat3f light = to_linear(Simulation(s).next()->image);
    double sum = 0;
    for (int x = 0; x < 64; ++x) sum += light(20, x)[1];
    const double white = light(20, 31)[1];
    // two edges, each to .1 px, and the rounding of codes in some four pixels
    EXPECT_NEAR(sum / white, focal_px * (0.2 - right_m) / 3, 0.2 + 0.02);
  }
}

/// Light between two codes of 8 bits stays between them until the sensor.
TEST(Render, TheLightOfASurfaceIsFinerThanTheCodesOfAPicture) {
  const auto light_of = [](double code) {
    return Simulation(sheet(9, -9, fmt::format("{0} {0} {0} 1", code / 255)))
        .next()
        ->rendered(20, 20)[1];
  };
  const float dark = light_of(4), next = light_of(5);
  for (const double part : {0.25, 0.5, 0.75}) {
    EXPECT_NEAR((light_of(4 + part) - dark) / (next - dark), part, 0.01);
  }
}

TEST(Render, ACylinderIsRound) {
  scenario::Scenario s = scenario_in_mjcf(
      floor_with("<body name='pole' pos='3 0 .5'><geom type='cylinder' size='.9 .5'/></body>"), 0,
      1);
  for (const double yaw : {0.0, 0.03, 0.06}) {
    s.ego.heading_rad = yaw;  // other sides of the prism make the outline
    Simulation simulation(s);
    const Observation o = *simulation.next();
    const Vector3d eye = o.truth.now.T_WC.p;
    const double away_m = (Vector3d(3, 0, 0) - eye).head<2>().norm();
    // the half angle of the outline, and the rows of pixels that show it
    const double half = std::asin(0.9 / away_m), to_axis = std::atan2(-eye.y(), 3 - eye.x()) - yaw;
    const Pinhole camera = simulation.calibration().camera;
    const int row = cvRound(camera.centre_px.y());  // level with the eye
    int first = -1, last = -1;
    for (int x = 0; x < camera.width_px; ++x) {
      if (o.truth.object(row, x) != 1) continue;
      if (first < 0) first = x;
      last = x;
    }
    const double left_px = camera.centre_px.x() - camera.focal_px * std::tan(to_axis + half);
    const double right_px = camera.centre_px.x() - camera.focal_px * std::tan(to_axis - half);
    EXPECT_NEAR(first - 0.5, left_px, 0.5 + 0.35) << yaw;  // .12 % of some 290 px
    EXPECT_NEAR(last + 0.5, right_px, 0.5 + 0.35) << yaw;
  }
}

TEST(Render, DepthIsAlongTheOpticalAxisAndNotAlongTheRay) {
  // a wall across the view, 5 m before the camera
  const auto s =
      scenario_in_mjcf(floor_with("<geom type='box' pos='5.7 0 0' size='.5 20 20'/>"), 0, 1);
  Simulation simulation(s);
  const Observation o = simulation.next().value();
  for (const cv::Point px : {cv::Point(320, 100), cv::Point(2, 2), cv::Point(637, 3)}) {
    EXPECT_NEAR(o.truth.depth_m(px), 5, 1e-3);
  }
}

TEST(Render, SkyIsInfinitelyFarAndNoLandmark) {
  Simulation simulation(scenario_in_mjcf(floor_with(""), 0, 1));
  const Observation o = simulation.next().value();
  EXPECT_TRUE(std::isinf(o.truth.depth_m(10, 320)));
  EXPECT_EQ(o.truth.object(10, 320), -1);
  EXPECT_EQ(o.truth.object(470, 320), 0);
}

TEST(Render, TheRoverItselfIsNoLandmark) {
  auto s = scenario_in_mjcf(floor_with(""), 0, 1);
  s.camera.mount_position_m = {-0.6, 0, 0.6};  // looks at its own back
  s.camera.mount_rpy_rad = {0, 0.4, 0};
  Simulation simulation(s);
  const Observation o = simulation.next().value();
  int rover_px = 0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      rover_px += o.truth.object(y, x) == -1 && std::isfinite(o.truth.depth_m(y, x));
    }
  }
  EXPECT_GT(rover_px, 1000);
}

TEST(Render, TheGroundTruthPassLeavesNoTraceInTheColourImage) {
  World world(scenario_in("lab", 0, 1));
  LensRenderer renderer(world.model(), world.camera_id(), Pinhole::from_fovy(640, 480, 1));
  cv::Mat3f before, after;
  cv::Mat1f depth;
  cv::Mat1i geom;
  renderer.update();
  renderer.render_light(before);
  renderer.render_depth_and_geoms(depth, geom);
  renderer.render_light(after);
  EXPECT_EQ(cv::norm(before, after, cv::NORM_INF), 0);
}

TEST(Render, TwoRenderersInOneProcessDoNotDisturbEachOther) {
  World world(scenario_in("lab", 0, 1));
  World small_world(scenario_in("lab", 0, 1));
  LensRenderer renderer(world.model(), world.camera_id(), Pinhole::from_fovy(640, 480, 1));
  renderer.update();
  cv::Mat3f alone, beside;
  renderer.render_light(alone);
  {
    LensRenderer other(small_world.model(), small_world.camera_id(), Pinhole::from_fovy(64, 48, 1));
    other.update();
    cv::Mat3f small;
    other.render_light(small);
    renderer.render_light(beside);
    EXPECT_EQ(cv::norm(alone, beside, cv::NORM_INF), 0);
  }
  renderer.render_light(beside);
  EXPECT_EQ(cv::norm(alone, beside, cv::NORM_INF), 0) << "after the other one is gone";
}

TEST(Render, AnImageLargerThanGlCanDrawIsAnErrorAndNotClipped) {
  World world(scenario_in_mjcf(floor_with(""), 0, 1));
  const std::string what = lcs::test::refusal_of<std::runtime_error>([&] {
    const View large{Pinhole::from_fovy(100'000, 100'000, 1), 0, {}};
    CameraRenderer(world.model(), world.camera_id(), large, large);
  });
  EXPECT_NE(what.find("100000x100000"), std::string::npos) << what;
}

}  // namespace
}  // namespace lcs::sim
