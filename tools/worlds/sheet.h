/// \file
/// A world at a glance.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "tools/worlds/world.h"

namespace lcs::worlds {

/// First, middle and last picture as the camera has them, with the truth's boxes (what moves in
/// magenta), and the plan from above: what stands, the rover's way (blue), the movers' (magenta).
/// \param scenario the file of that world.
/// \throws what a simulation throws.
cv::Mat3b contact_sheet(const World& world, const std::filesystem::path& scenario);

}  // namespace lcs::worlds
