/// \file
/// A world at a glance: first, middle and last picture with the truth's boxes, and the plan.
#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/truth.h"
#include "tools/worlds/world.h"

namespace lcs::worlds {

/// From above, by the commands alone: what stands, the rover's way with what it sees at first and
/// at last (blue), and the movers' (magenta).
cv::Mat3b plan(const World& world);

/// A frame, as the camera or a recording has it.
struct Shot {
  int frame = 0;
  cv::Mat3b picture;
  double scale = 1;  ///< pixels of the picture for one of the camera's image
  std::vector<sim::ObjectTruth> objects;
};
using Shots = std::array<Shot, 3>;

/// Which frames those are.
std::array<int, 3> frames_shown(int frames);

/// \param plan may be empty. \param columns that pictures and plan stand in.
/// What moves has boxes in magenta, what stands in green.
cv::Mat3b contact_sheet(const Shots& shots, const cv::Mat3b& plan, int columns);

/// The shots of a simulation. \param scenario the file of a world, of three frames or more.
/// \throws what a simulation throws.
Shots simulated_shots(const std::filesystem::path& scenario);

}  // namespace lcs::worlds
