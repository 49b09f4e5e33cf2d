/// \file
/// An overview of a world: first, middle and last picture with the truth's boxes, and the plan.
#pragma once

#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "scenes/worlds/world.h"
#include "sim/truth/truth.h"

namespace lcs::preview {

/// Plan view from the commands: static things, the rover's path with its first and last field of
/// view (blue), and the movers' paths (magenta).
cv::Mat3b plan(const worlds::DrawnWorld& world);

/// A frame of the camera or of a recording.
struct Shot {
  int frame = 0;
  cv::Mat3b picture;
  double scale = 1;  ///< picture pixels per camera pixel
  std::vector<sim::ObjectTruth> objects;
};
using Shots = std::array<Shot, 3>;

/// The indices of the first, middle and last frame.
std::array<int, 3> frames_shown(int frames);

/// Draws magenta boxes round movers, green ones round static objects.
/// \param plan may be empty. \param columns of the sheet's grid.
cv::Mat3b contact_sheet(const Shots& shots, const cv::Mat3b& plan, int columns);

/// The shots of a simulation. \param scenario file of a world with at least three frames.
/// \throws the simulation's exceptions.
Shots simulated_shots(const std::filesystem::path& scenario);

}  // namespace lcs::preview
