/// \file
/// Pictures in linear light, which adds up, scales with the exposure and makes shot noise. 1 is a
/// white surface in daylight as the renderer shows it. The transfer curve is sRGB's (IEC
/// 61966-2-1).
#pragma once

#include <opencv2/core.hpp>

namespace lcs::sim {

cv::Mat3f to_linear(const cv::Mat3b& picture);

/// The inverse of `to_linear`, exact for each code. Clips what is below 0 or above 1.
void to_codes(const cv::Mat3f& linear, cv::Mat3b& picture);

}  // namespace lcs::sim
