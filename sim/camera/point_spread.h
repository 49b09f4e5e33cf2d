/// \file
/// The point spread of a lens: the light of a point becomes a Gaussian.
#pragma once

#include <opencv2/core.hpp>

namespace lcs::sim {

/// Spreads linear light. Even light stays even; at the border the outermost pixels continue. The
/// same bits on any machine.
/// \param sigma_px standard deviation along each axis; 0: nothing changes.
void spread_points(cv::Mat3f& light, double sigma_px);

}  // namespace lcs::sim
