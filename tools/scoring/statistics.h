/// \file
/// Means, quantiles and ratios. They are undefined, not 0, without values.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace lcs::scoring {

/// part / whole, of any numbers; undefined if whole is 0.
std::optional<double> ratio(auto part, auto whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

inline std::optional<double> mean(const std::vector<double>& values) {
  return ratio(std::accumulate(values.begin(), values.end(), 0.0), values.size());
}

/// Linear interpolation between the nearest ranks (type 7, NumPy's default). \param q in [0, 1].
inline std::optional<double> quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const double rank = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(rank));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], rank - std::floor(rank));
}

inline std::optional<double> median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

}  // namespace lcs::scoring
