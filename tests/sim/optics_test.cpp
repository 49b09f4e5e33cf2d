// Lenses against OpenCV's projections, and their pictures against rays cast through the model.
#include "sim/base/optics.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/base/random.h"
#include "sim/camera/lens_renderer.h"
#include "sim/camera/linear_light.h"
#include "sim/simulation.h"
#include "sim/world/world.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// A camera of EuRoC, the middle of a fisheye of TUM-VI at half its size, pixels that are not
/// square, and a barrel with a principal point far from the middle.
std::vector<scenario::Camera> cameras() {
  const auto camera = [](int width, int height, Vector2d focal, Vector2d centre,
                         scenario::Distortion distortion) {
    scenario::Camera c;
    c.source = {"test.yaml", 3};
    c.width_px = width;
    c.height_px = height;
    c.focal_px = focal;
    c.centre_px = centre;
    c.distortion = std::move(distortion);
    c.mount_position_m = {0.2, 0, 0.45};
    return c;
  };
  return {camera(752, 480, {458.654, 457.296}, {367.215, 248.375},
                 {false, {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0}}),
          camera(200, 140, {95.5, 95.4}, {99.2, 70.4},
                 {true, {0.0034823894, 0.0007150348, -0.0020532361, 0.00020293673}}),
          camera(320, 240, {200, 260}, {159.5, 119.5}, {false, {0, 0, 0, 0, 0}}),
          camera(320, 240, {250, 250}, {90, 150}, {false, {-0.1, 0.02, 0.002, -0.001, 0.003}})};
}

Vector2d by_opencv(const Lens& lens, const Vector3d& x_C) {
  const cv::Matx33d K(lens.fu_px, 0, lens.cu_px, 0, lens.fv_px, lens.cv_px, 0, 0, 1);
  const std::vector<cv::Point3d> points{{x_C.x(), x_C.y(), x_C.z()}};
  std::vector<cv::Point2d> px;
  const cv::Vec3d zero(0, 0, 0);
  if (lens.distortion == Lens::Distortion::equidistant) {
    cv::fisheye::projectPoints(points, px, zero, zero, K, lens.coefficients);
  } else {
    cv::projectPoints(points, zero, zero, K, lens.coefficients, px);
  }
  return {px[0].x, px[0].y};
}

TEST(Optics, ProjectPointsAsOpenCvDoes) {
  for (const scenario::Camera& camera : cameras()) {
    const Optics optics(lens_of(camera));
    RandomStream random(1, "points");
    int seen = 0;
    for (int i = 0; i < 2000; ++i) {
      const double z = 0.5 + 10 * random.uniform();
      const Vector3d x_C(z * (2 * random.uniform() - 1), z * (2 * random.uniform() - 1), z);
      const Vector2d px = optics.project(x_C);
      const bool is_inside = px.allFinite() && px.x() >= 0 && px.y() >= 0 &&
                             px.x() < camera.width_px && px.y() < camera.height_px;
      if (!is_inside) continue;
      ++seen;
      EXPECT_LT((px - by_opencv(optics.lens(), x_C)).norm(), 1e-9);
    }
    EXPECT_GT(seen, 300);
  }
}

TEST(Optics, ProjectThePointOfAPixelBackToIt) {
  for (const scenario::Camera& camera : cameras()) {
    const Optics optics(lens_of(camera));
    for (int y = 0; y < camera.height_px; y += 13) {
      for (int x = 0; x < camera.width_px; x += 11) {
        EXPECT_LT((optics.project(optics.back_project({x, y}, 3)) - Vector2d(x, y)).norm(), 1e-6);
        const Vector2d ray = optics.ray(x, y).head<2>();
        Matrix2d slopes;  // by central differences
        constexpr double kStep = 1e-5;
        for (int axis = 0; axis < 2; ++axis) {
          const Vector2d step = kStep * Vector2d::Unit(axis);
          slopes.col(axis) = (optics.project((ray + step).homogeneous()) -
                              optics.project((ray - step).homogeneous())) /
                             (2 * kStep);
        }
        if (!slopes.allFinite()) continue;  // at the end of the distortion's range
        EXPECT_TRUE(optics.jacobian_px(ray).isApprox(slopes, 1e-6));
      }
    }
  }
}

TEST(Optics, RefuseALensWhosePixelsHaveNoRay) {
  scenario::Camera camera = cameras().front();
  camera.distortion->coefficients = {-0.9, 0, 0, 0, 0};
  EXPECT_NE(test::scenario_error([&] {
              Optics{lens_of(camera)};
            }).find("test.yaml:3: camera.distortion: the pixel (0, 0) has no ray"),
            std::string::npos);
  camera.distortion = scenario::Distortion{true, {0, 0, 0, 0}};
  camera.focal_px = Vector2d(255, 255);  // the corners are 100 deg off the axis
  EXPECT_NE(test::scenario_error([&] { Optics{lens_of(camera)}; }).find("has no ray"),
            std::string::npos);
}

/// A room of boxes: flat surfaces in many directions.
scenario::Scenario boxes(const scenario::Camera& camera) {
  scenario::Scenario s =
      test::scenario_in_mjcf(test::floor_with(R"(<geom type="box" pos="6 0 2" size=".1 8 2"/>
        <geom type="box" pos="3 5 2" size="8 .1 2"/> <geom type="box" pos="3 -5 2" size="8 .1 2"/>
        <body name="crate" pos="2.5 .6 .5" euler="0 0 30"><geom type="box" size=".5 .3 .5"/></body>
        <body name="board" pos="2 -.5 .6" euler="20 40 0"><geom type="box" size=".4 .3 .02"/></body>)"),
                             0, 1);
  s.camera = camera;
  return s;
}

TEST(LensRenderer, HasTheDepthAndTheGeomOfEachPixelsRay) {
  std::vector<scenario::Camera> all = cameras();
  all.push_back(all.back());  // a pinhole, which is rendered without resampling
  all.back().distortion.reset();
  for (const scenario::Camera& camera : all) {
    World world(boxes(camera));
    const Optics optics(lens_of(camera));
    LensRenderer renderer(world.model(), world.camera_id(), optics, 5, world.groups());
    renderer.update();
    cv::Mat1f depth_m;
    cv::Mat1i geom;
    renderer.render_depth_and_geoms(depth_m, geom);
    const Pose T_WC = world.snapshot().T_WC;
    const int rover = world.model().id(mjOBJ_BODY, kEgoBody);
    int compared = 0, other_geom = 0, far_from_depth = 0;
    for (int y = 1; y + 1 < depth_m.rows; y += 3) {
      for (int x = 1; x + 1 < depth_m.cols; x += 3) {
        if (geom(y, x) >= 0 && world.object_of_geom(geom(y, x)) < 0) continue;  // the rover
        const auto cast = [&](double u, double v, double& distance) {
          int hit = -1;
          const Vector3d direction = T_WC.R * optics.back_project({u, v}, 1);
          distance = mj::ray(world.model().m(), world.model().d(), T_WC.p.data(), direction.data(),
                             rover, hit);
          return hit;
        };
        ++compared;
        double distance = 0, beside = 0;
        const int hit = cast(x, y, distance);
        // at an outline the geom is that of a ray within a quarter of a pixel
        bool is_near = hit == geom(y, x);
        for (const double u : {-0.26, 0.26}) {
          for (const double v : {-0.26, 0.26}) {
            if (!is_near) is_near = cast(x + u, y + v, beside) == geom(y, x);
          }
        }
        other_geom += !is_near;
        if (hit != geom(y, x) || hit < 0) continue;
        far_from_depth += !(std::abs(depth_m(y, x) - distance) < 1e-3 * distance);
      }
    }
    EXPECT_GT(compared, 2000);
    EXPECT_LE(other_geom, compared / 1000) << camera.width_px;
    // beside edges within a geom
    EXPECT_LE(far_from_depth, compared / 100) << camera.width_px;
  }
}

TEST(LensRenderer, RefusesALensThatNeedsTooLargeAPicture) {
  scenario::Camera camera = cameras().front();
  camera.width_px = 5200;
  camera.height_px = 200;
  camera.focal_px = Vector2d(2000, 2000);
  camera.centre_px.reset();
  camera.distortion = scenario::Distortion{true, {0, 0, 0, 0}};
  scenario::Scenario s = boxes(camera);
  s.image.samples = 5;
  EXPECT_NE(test::scenario_error([&] {
              Simulation{s};
            }).find("test.yaml:3: camera.distortion: the picture would be made of"),
            std::string::npos);
}

/// Standard deviation of the spread across an upright edge, px, over many phases of the edge.
double spread_px(const scenario::Camera& camera) {
  scenario::Scenario s = test::scenario_in_mjcf(
      R"(<mujoco><statistic extent="10"/><visual><headlight ambient="1 1 1" diffuse="0 0 0"/>
      </visual><worldbody><geom type="box" pos="4 0 0" size=".1 20 20" rgba="0 0 0 1"/>
      <geom type="box" pos="3 -3 .45" size=".1 3 9" euler="3 0 0" rgba="1 1 1 1"/>
      <geom type="plane" size="9 9 .1" pos="0 0 -9"/></worldbody></mujoco>)",
      0, 1);
  s.camera = camera;
  s.image.samples = scenario::Image{}.samples;
  Simulation simulation(s);
  const cv::Mat3f light = to_linear(simulation.next()->image);
  double sum = 0;
  int rows = 0;
  for (int y = light.rows / 2 - 60; y < light.rows / 2 + 60; ++y, ++rows) {
    double weight = 0, mean = 0, square = 0;
    for (int x = light.cols / 2 - 20; x < light.cols / 2 + 20; ++x) {
      const double step = light(y, x + 1)[1] - light(y, x)[1], at = x - light.cols / 2;
      weight += step;
      mean += step * at;
      square += step * at * at;
    }
    EXPECT_GT(weight, 0.5);
    sum += square / weight - mean * mean / weight / weight;
  }
  return std::sqrt(sum / rows);
}

TEST(LensRenderer, SpreadsAPointAsAPinholeDoes) {
  scenario::Camera camera;
  camera.mount_position_m = {0.2, 0, 0.45};
  const double pinhole_px = spread_px(camera);
  camera.distortion = scenario::Distortion{false, {-0.2, 0.05, 0, 0, 0}};
  const double lens_px = spread_px(camera);
  // the lens's point spread, the area of a pixel, and the difference of two pixels
  const double expected_px =
      std::hypot(scenario::Image{}.point_spread_px, 1 / std::sqrt(12.0), 1 / std::sqrt(12.0));
  EXPECT_NEAR(pinhole_px, expected_px, 0.02);
  EXPECT_NEAR(lens_px, expected_px, 0.02);
}

}  // namespace
}  // namespace lcs::sim
