/// \file
/// Scenarios for tests, as typed values instead of YAML.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <numbers>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulation.h"
#include "tests/tools/refusal.h"

namespace lcs::sim {

/// The linear light of a picture's codes: the inverse of `to_codes`.
cv::Mat3f to_linear(const cv::Mat3b& picture);

}  // namespace lcs::sim

namespace lcs::sim::test {

inline constexpr double kDegree = std::numbers::pi / 180;

/// A rover that drives along x at a constant speed, with an ideal IMU and a camera without noise
/// and with one sample a pixel, which is fastest, in a scene of the project.
scenario::Scenario scenario_in(const std::string& scene, double speed_mps, int frames);

/// The same in a scene given as MJCF, written to a file that exists as long as the test.
scenario::Scenario scenario_in_mjcf(const std::string& mjcf, double speed_mps, int frames);

/// MJCF of a flat floor, with `more` put into its worldbody.
std::string floor_with(const std::string& more);

/// An actor of a shape on a straight line.
scenario::Actor line_actor(const std::string& name, scenario::Shape shape,
                           const Eigen::Vector2d& from_m, double heading_rad, double speed_mps);

/// The optics of a scenario's camera without distortion.
inline Pinhole pinhole_of(const scenario::Camera& camera) {
  return Pinhole::from_fovy(camera.width_px, camera.height_px, camera.fovy_rad);
}

/// The picture that a noiseless camera makes of rendered light, in daylight.
cv::Mat3b behind_lens(cv::Mat3f light);

/// FAST-9 corners with non-maximum suppression, px.
std::vector<Eigen::Vector2f> fast_corners(const cv::Mat3b& image, int threshold = 20);

template <typename Action>
std::string scenario_error(const Action& action) {
  return lcs::test::refusal_of<input::Error>(action);
}

/// Message of the PhysicsError of a drive until `until_ns`.
std::string physics_error(const scenario::Scenario& scenario, std::int64_t until_ns);

double median(std::vector<double> values);

}  // namespace lcs::sim::test
