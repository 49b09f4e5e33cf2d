/// \file
/// Makes pictures with MuJoCo's shadow maps usable: without speckles, and with their edges known.
#pragma once

#include <opencv2/core.hpp>

namespace lcs::sim {

/// The texels of shadow maps leave speckles on lit surfaces: a pixel takes the median share of
/// light of the pixels of its geom in the 5 x 5 round it. Pixels beside another geom, which mix two
/// surfaces, keep their share. Shadows below 3 px in width are lost.
/// \param even linear light without shadows, \param shaded the same with them, changed in place.
/// \param geom of each pixel's middle, -1 for the background.
/// \return 1 at the edges of shadows: at neighbouring pixels of a geom that keep shares of their
///   light that differ by more than 9 %.
cv::Mat1b clean_shadows(const cv::Mat3f& even, const cv::Mat1i& geom, cv::Mat3f& shaded);

}  // namespace lcs::sim
