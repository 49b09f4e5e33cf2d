/// \file
/// A variance as it is seen, beside the one that is set.
#pragma once

#include <algorithm>

namespace lcs {

class SeenVariance {
 public:
  /// \param least that is set: nothing is less, and it counts as so many that were seen.
  double or_more(double least, int count) const {
    const double weight = count + weight_;
    return weight > 0 ? std::max(least, (count * least + sum_) / weight) : least;
  }
  /// \param kept share of what was seen that still holds.
  void fade(double kept) {
    sum_ *= kept;
    weight_ *= kept;
  }
  /// \param square of how far off it was, on an axis.
  void see(double square, double weight) {
    sum_ += weight * square;
    weight_ += weight;
  }

 private:
  double sum_ = 0, weight_ = 0;
};

}  // namespace lcs
