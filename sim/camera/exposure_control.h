/// \file
/// Automatic exposure and gain: each picture sets both for the next picture.
///
/// The product p of exposure and gain is the factor from light to the picture's grey. With m the
/// mean of the exposed picture of frame k, in linear light, clipped at 1, over all pixels and
/// channels, and T the time to the next frame,
///
///     ln p(k+1) = ln p(k) + (1 - exp(-T / time_constant)) (ln target - ln m(k))
///
/// within the bounds. Where no pixel is clipped, m is proportional to p, so that the deviation of
/// ln m from ln target shrinks by exp(-T / time_constant) a frame. The exposure is as long as its
/// bounds allow with the least gain; the gain makes the rest. The control sees light after noise,
/// before compression.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "scenarios/scenario.h"

namespace lcs::sim {

struct Exposure {
  double time_s = 0;
  double gain = 1;
};

class ExposureControl {
 public:
  /// \param period_s from one frame to the next.
  ExposureControl(const scenario::Image& image, double period_s);

  /// Of the next picture.
  const Exposure& next() const { return next_; }
  /// \param exposed the next picture, in linear light. Without `auto_exposure` nothing changes.
  void see(const cv::Mat3f& exposed);

 private:
  std::optional<scenario::Image::AutoExposure> control_;
  Eigen::Vector2d exposure_s_;  ///< least and most
  double share_ = 0;            ///< of the deviation that one frame takes away
  Exposure next_;
};

}  // namespace lcs::sim
