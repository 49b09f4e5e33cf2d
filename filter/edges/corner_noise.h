/// \file
/// The noise of one corner's place, from its own track.
#pragma once

#include <algorithm>

namespace lcs {

/// Sums of squared misses of a corner, under either hypothesis. A corner is as noisy as the others
/// of the frame until it has shown otherwise (MODEL.md (17)).
class CornerNoise {
 public:
  /// Variance on an axis, px^2.
  /// \param scene_px2 the variance of the frame's corners.
  /// \param scene_weight number of sightings as which that counts.
  double variance_px2(double scene_px2, double scene_weight) const {
    const double mean = (scene_weight * scene_px2 + sum_px2_) / (scene_weight + weight_);
    return std::max(1.0 / 12, mean);  // a place that is rounded to whole pixels has at least that
  }

  void fade(double kept) {
    sum_px2_ *= kept;
    weight_ *= kept;
  }
  /// \param miss2_px2 squared distance from the estimated place, plus the trace of its covariance.
  /// \param weight chance of the hypothesis that estimated it.
  void add(double miss2_px2, double weight) {
    sum_px2_ += weight * miss2_px2 / 2;
    weight_ += weight;
  }

 private:
  double sum_px2_ = 0, weight_ = 0;
};

}  // namespace lcs
