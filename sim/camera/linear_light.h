/// \file
/// Images in linear light, which is additive, proportional to the exposure, and the basis of shot
/// noise. 1 is a white surface in daylight as rendered. The transfer curve is sRGB's (IEC
/// 61966-2-1).
#pragma once

#include <opencv2/core.hpp>

namespace lcs::sim {

cv::Mat3f to_linear(const cv::Mat3b& picture);

/// The inverse of `to_linear`, exact for each code. Clips values to [0, 1].
void to_codes(const cv::Mat3f& linear, cv::Mat3b& picture);

}  // namespace lcs::sim
