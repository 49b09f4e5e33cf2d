#include "sim/camera/linear_light.h"

#include <algorithm>
#include <cmath>

namespace lcs::sim {
namespace {

constexpr int kCodes = 256;
/// Fine enough for the steepest part of the curve, where a code is 3e-4 wide.
constexpr int kBins = 1 << 14;

/// \param v the code over the largest code
float linear_of(double v) {
  return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}

struct Curve {
  cv::Mat1f linear = cv::Mat1f(1, kCodes);
  std::vector<std::uint8_t> code;  ///< nearest to the middle of each bin of [0, 1]

  Curve() : code(kBins + 1) {
    for (int c = 0; c < kCodes; ++c) linear(c) = linear_of(c / 255.0);
    int nearest = 0;
    for (int bin = 0; bin <= kBins; ++bin) {
      const float value = static_cast<float>(bin) / kBins;
      while (nearest + 1 < kCodes &&
             std::abs(linear(nearest + 1) - value) <= std::abs(linear(nearest) - value)) {
        ++nearest;
      }
      code[static_cast<std::size_t>(bin)] = static_cast<std::uint8_t>(nearest);
    }
  }
};

const Curve& curve() {
  static const Curve it;
  return it;
}

}  // namespace

const std::vector<float>& light_of_codes16() {
  static const std::vector<float> light = [] {
    constexpr int kCodes16 = 1 << 16;
    std::vector<float> of_code;
    for (int c = 0; c < kCodes16; ++c) of_code.push_back(linear_of(c / (kCodes16 - 1.0)));
    return of_code;
  }();
  return light;
}

cv::Mat3f to_linear(const cv::Mat3b& picture) {
  cv::Mat3f linear;
  cv::LUT(picture, curve().linear, linear);
  return linear;
}

void to_codes(const cv::Mat3f& linear, cv::Mat3b& picture) {
  picture.create(linear.size());
  const Curve& table = curve();
  std::vector<int> bins(static_cast<std::size_t>(3 * linear.cols));
  for (int y = 0; y < linear.rows; ++y) {
    const float* from = linear[y]->val;
    std::transform(from, from + bins.size(), bins.begin(), [](float light) {
      return static_cast<int>(std::clamp(light, 0.F, 1.F) * kBins + 0.5F);
    });
    std::transform(bins.begin(), bins.end(), picture[y]->val,
                   [&](int bin) { return table.code[static_cast<std::size_t>(bin)]; });
  }
}

}  // namespace lcs::sim
