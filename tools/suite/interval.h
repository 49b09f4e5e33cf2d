/// \file
/// How far a mean can be believed.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lcs::suite {

/// The two-sided 95 % quantile of Student's t. \param degrees_of_freedom >= 1. Error below 0.0005.
double student_t_95(int degrees_of_freedom);

/// A mean with the interval that holds it at 95 %, if what differs between the values is normal.
struct Interval {
  double mean = 0;
  std::optional<double> half;  ///< none: of a single value, whose noise is unknown
};

/// \param values at least one.
Interval interval_of(const std::vector<double>& values);

/// What stands behind a number of so many decimals: "±.05", four columns and more; blank where no
/// digit of it would show.
std::string half_text(double half, int decimals);

}  // namespace lcs::suite
