/// \file
/// The noise of corners' places, from how far they miss their estimates.
#pragma once

namespace lcs {

/// Faded sums of squared misses: of all corners of a frame, or of one corner on its track
/// (MODEL.md (17)).
class CornerNoise {
 public:
  /// Variance on an axis, px^2.
  /// \param usual_px2 the variance of corners that have shown nothing yet.
  /// \param usual_weight number of sightings as which that counts.
  double variance_px2(double usual_px2, double usual_weight) const {
    const double weight = usual_weight + weight_;
    return weight > 0 ? (usual_weight * usual_px2 + sum_px2_) / weight : usual_px2;
  }

  void fade(double kept) {
    sum_px2_ *= kept;
    weight_ *= kept;
  }
  /// \param sum_px2 sum of weight times half of the squared distance from the estimated place, plus
  ///   the trace of its covariance.
  /// \param weight sum of the chances of the hypothesis that estimated it.
  void add(double sum_px2, double weight) {
    sum_px2_ += sum_px2;
    weight_ += weight;
  }

 private:
  double sum_px2_ = 0, weight_ = 0;
};

}  // namespace lcs
