/// \file
/// The median, by which a group's value does not depend on a few wrong ones.
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

namespace lcs {

/// The upper one of the two middle values of an even number. Reorders the values; needs at least
/// one.
template <class Number>
Number median(std::vector<Number>& values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace lcs
