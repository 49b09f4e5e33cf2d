/// \file
/// Pixels that show one surface alone: beside others, a pixel of a picture mixes surfaces.
#pragma once

#include <opencv2/core.hpp>

namespace lcs::sim {

/// Not 0 where the pixels beside, also diagonally, have the same geom; beyond the border there are
/// none.
cv::Mat1b inner_pixels(const cv::Mat1i& geom);

}  // namespace lcs::sim
