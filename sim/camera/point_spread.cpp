#include "sim/camera/photograph.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lcs::sim {
namespace {

/// The middle weight and those on one side of it; all add up to 1.
std::vector<float> weights_of(double sigma_px) {
  const int reach = static_cast<int>(std::ceil(3 * sigma_px));
  std::vector<double> exact;
  double sum = 0;
  for (int k = 0; k <= reach; ++k) {
    exact.push_back(std::exp(-k * k / (2 * sigma_px * sigma_px)));
    sum += (k == 0 ? 1 : 2) * exact.back();
  }
  std::vector<float> weights;
  for (const double w : exact) weights.push_back(static_cast<float>(w / sum));
  return weights;
}

/// to = w0 of + sum of w_k (before_k + after_k), for `count` floats.
void weigh(const std::vector<float>& weights, const float* of, int count, float* to,
           const auto& beside) {
  for (int i = 0; i < count; ++i) to[i] = weights[0] * of[i];
  for (int k = 1; k < static_cast<int>(weights.size()); ++k) {
    const float w = weights[static_cast<std::size_t>(k)];
    const auto [before, after] = beside(k);
    for (int i = 0; i < count; ++i) to[i] += w * (before[i] + after[i]);
  }
}

}  // namespace

void spread_points(cv::Mat3f& light, double sigma_px) {
  if (sigma_px <= 0 || light.empty()) return;
  const std::vector<float> weights = weights_of(sigma_px);
  const int reach = static_cast<int>(weights.size()) - 1, count = 3 * light.cols;
  cv::Mat3f across(light.size());
  std::vector<cv::Vec3f> wide(static_cast<std::size_t>(light.cols + 2 * reach));
  const float* const first = wide.front().val + 3 * reach;
  for (int y = 0; y < light.rows; ++y) {
    const cv::Vec3f* row = light[y];
    std::copy_n(row, light.cols, wide.begin() + reach);
    std::fill_n(wide.begin(), reach, row[0]);
    std::fill_n(wide.end() - reach, reach, row[light.cols - 1]);
    weigh(weights, first, count, across[y]->val,
          [&](int k) { return std::pair(first - 3 * k, first + 3 * k); });
  }
  const auto row = [&](int y) {
    return static_cast<const float*>(across[std::clamp(y, 0, light.rows - 1)]->val);
  };
  for (int y = 0; y < light.rows; ++y) {
    weigh(weights, row(y), count, light[y]->val,
          [&](int k) { return std::pair(row(y - k), row(y + k)); });
  }
}

}  // namespace lcs::sim
