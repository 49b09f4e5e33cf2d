#include "sim/camera/linear_light.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lcs::sim {
namespace {

constexpr int kCodes = 256;
/// Fine enough for the steepest part of the curve, where a code is 3e-4 wide.
constexpr int kBins = 1 << 14;

/// The code of 8 bits that is nearest to the middle of each bin of [0, 1].
const std::vector<std::uint8_t>& code_of_bins() {
  static const std::vector<std::uint8_t> codes = [] {
    std::vector<std::uint8_t> of_bin;
    int nearest = 0;
    const auto off = [](int code, float value) {
      return std::abs(light_of_codes16()[static_cast<std::size_t>(257 * code)] - value);
    };
    for (int bin = 0; bin <= kBins; ++bin) {
      const float value = static_cast<float>(bin) / kBins;
      while (nearest + 1 < kCodes && off(nearest + 1, value) <= off(nearest, value)) ++nearest;
      of_bin.push_back(static_cast<std::uint8_t>(nearest));
    }
    return of_bin;
  }();
  return codes;
}

}  // namespace

const std::vector<float>& light_of_codes16() {
  static const std::vector<float> light = [] {
    constexpr int kCodes16 = 1 << 16;
    std::vector<float> of_code;
    for (int c = 0; c < kCodes16; ++c) {
      const double v = c / (kCodes16 - 1.0);
      of_code.push_back(
          static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)));
    }
    return of_code;
  }();
  return light;
}

void to_codes(const cv::Mat3f& linear, cv::Mat3b& picture) {
  picture.create(linear.size());
  const std::vector<std::uint8_t>& codes = code_of_bins();
  std::vector<int> bins(static_cast<std::size_t>(3 * linear.cols));
  for (int y = 0; y < linear.rows; ++y) {
    const float* from = linear[y]->val;
    std::transform(from, from + bins.size(), bins.begin(), [](float light) {
      return static_cast<int>(std::clamp(light, 0.F, 1.F) * kBins + 0.5F);
    });
    std::transform(bins.begin(), bins.end(), picture[y]->val,
                   [&](int bin) { return codes[static_cast<std::size_t>(bin)]; });
  }
}

}  // namespace lcs::sim
