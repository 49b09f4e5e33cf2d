/// \file
/// Confidence intervals of means.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lcs::suite {

/// The two-sided 95 % quantile of Student's t. \param degrees_of_freedom >= 1. Error below 0.0005.
double student_t_95(int degrees_of_freedom);

/// A mean with its 95 % confidence interval, which assumes normally distributed values.
struct Interval {
  double mean = 0;
  std::optional<double> half;  ///< half width; absent for a single value, whose noise is unknown
};

/// \param values at least one value.
Interval interval_of(const std::vector<double>& values);

/// The half width after a number with this many decimals: "±.05", padded to at least four columns;
/// blank if it rounds to zero.
std::string half_text(double half, int decimals);

}  // namespace lcs::suite
