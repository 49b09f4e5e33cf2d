#include "tests/sim/support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/camera/linear_light.h"
#include "sim/camera/photograph.h"
#include "sim/world/world.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::sim {

cv::Mat3f to_linear(const cv::Mat3b& picture) {
  cv::Mat1f light(1, 256);
  for (int code = 0; code < 256; ++code) {
    light(code) = light_of_codes16()[static_cast<std::size_t>(257 * code)];
  }
  cv::Mat3f linear;
  cv::LUT(picture, light, linear);
  return linear;
}

}  // namespace lcs::sim

namespace lcs::sim::test {

scenario::Scenario scenario_in(const std::string& scene, double speed_mps, int frames) {
  scenario::Scenario s;
  s.name = "test";
  s.file = "test.yaml";
  s.scene = std::filesystem::path(LCS_SOURCE_DIR) / "scenes" / (scene + ".xml");
  s.scene_source = {"test.yaml", 2};
  s.frames = frames;
  s.ego.start_m = {-4, 0};
  s.ego.phases = {{.speed_mps = speed_mps}};
  s.camera.fovy_rad = 60 * kDegree;
  s.camera.rate_hz = 10;
  s.camera.mount_position_m = {0.2, 0, 0.45};
  s.imu.preset = "ideal";
  s.image.noise.reset();
  s.image.samples = 1;
  return s;
}

scenario::Scenario scenario_in_mjcf(const std::string& mjcf, double speed_mps, int frames) {
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  const auto file = lcs::test::folder_of_the_process() / (test + ".xml");
  std::ofstream(file) << mjcf;
  scenario::Scenario s = scenario_in("lab", speed_mps, frames);
  s.scene = file;
  s.ego.start_m = {0, 0};
  return s;
}

std::string floor_with(const std::string& more) {
  return R"(<mujoco model="floor">
  <statistic extent="10" center="0 0 0"/>
  <worldbody>
    <light directional="true" dir="0 0 -1" castshadow="false"/>
    <geom name="floor" type="plane" size="50 50 .1" rgba=".5 .5 .5 1"/>
    )" + more +
         R"(
  </worldbody>
</mujoco>)";
}

scenario::Actor line_actor(const std::string& name, scenario::Shape shape,
                           const Eigen::Vector2d& from_m, double heading_rad, double speed_mps) {
  scenario::Actor actor;
  actor.name = name;
  actor.source = {"test.yaml", 7};
  actor.shape = shape;
  actor.trajectory =
      scenario::Line{.from_m = from_m, .heading_rad = heading_rad, .speed_mps = speed_mps};
  return actor;
}

cv::Mat3b behind_lens(cv::Mat3f light) {
  light = light.clone();
  spread_points(light, scenario::Image{}.point_spread_px);
  cv::Mat3b picture;
  to_codes(light, picture);
  return picture;
}

std::vector<Eigen::Vector2f> fast_corners(const cv::Mat3b& image, int threshold) {
  cv::Mat1b grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  std::vector<cv::KeyPoint> found;
  cv::FAST(grey, found, threshold, true);
  std::vector<Eigen::Vector2f> corners;
  for (const cv::KeyPoint& k : found) corners.emplace_back(k.pt.x, k.pt.y);
  return corners;
}

std::string physics_error(const scenario::Scenario& scenario, std::int64_t until_ns) {
  return lcs::test::refusal_of<PhysicsError>([&] {
    World world(scenario);
    std::vector<ImuSample> imu;
    std::vector<OdometrySample> odometry;
    world.advance_to(until_ns, imu, odometry);
  });
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace lcs::sim::test
