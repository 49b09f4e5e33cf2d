/// \file
/// Scenarios for tests: typed values, so that nothing of YAML is in the way.
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

namespace lcs::sim::test {

inline constexpr double kDegree = std::numbers::pi / 180;

/// A rover that drives along x at a constant speed, with an ideal IMU and a camera without noise,
/// in a scene of the project.
scenario::Scenario scenario_in(const std::string& scene, double speed_mps, int frames);

/// The same in a scene that is given as MJCF; written to a file that lives as long as the test.
scenario::Scenario scenario_in_mjcf(const std::string& mjcf, double speed_mps, int frames);

/// A flat floor for rovers to drive on, and nothing else, with `more` put into its worldbody.
std::string floor_with(const std::string& more);

/// An actor of a shape on a straight line.
scenario::Actor line_actor(const std::string& name, scenario::Shape shape,
                           const Eigen::Vector2d& from_m, double heading_rad, double speed_mps);

/// Corners as the detector finds them: FAST-9 with non-maximum suppression.
std::vector<Eigen::Vector2f> fast_corners(const cv::Mat3b& image, int threshold = 20);

template <typename Action>
std::string scenario_error(const Action& action) {
  return bench::refusal_of<scenario::Error>(action);
}

/// The PhysicsError of a drive that takes so long.
std::string physics_error(const scenario::Scenario& scenario, std::int64_t until_ns);

double median(std::vector<double> values);

}  // namespace lcs::sim::test
