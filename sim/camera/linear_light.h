/// \file
/// Images in linear light, which is additive, proportional to the exposure, and the basis of shot
/// noise. 1 is a white surface in daylight as rendered. The transfer curve is sRGB's (IEC
/// 61966-2-1).
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace lcs::sim {

/// The codes of 8 bits of linear light, exact for the light of each code. Clips values to [0, 1].
void to_codes(const cv::Mat3f& linear, cv::Mat3b& picture);

/// Linear light of each code of 16 bits; those of 8 bits are multiples of 257.
const std::vector<float>& light_of_codes16();

}  // namespace lcs::sim
