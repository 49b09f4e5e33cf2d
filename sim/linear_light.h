/// \file
/// Pictures in linear light: what adds up, scales with exposure and makes shot noise. 1 is a white
/// surface in daylight as the renderer shows it. The transfer curve is sRGB's (IEC 61966-2-1).
#pragma once

#include <opencv2/core.hpp>

namespace lcs::sim {

cv::Mat3f to_linear(const cv::Mat3b& picture);

/// What is below 0 or above 1 is clipped. Takes each code of a picture back to itself.
void to_codes(const cv::Mat3f& linear, cv::Mat3b& picture);

}  // namespace lcs::sim
