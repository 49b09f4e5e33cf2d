/// \file
/// Pictures of any lens as a pinhole with square pixels would have taken them, which is what the
/// filter knows.
#pragma once

#include <opencv2/core.hpp>

#include "sim/pose.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

class Rectifier {
 public:
  /// \throws scenario::Error for a distortion that no lens has.
  Rectifier(const Lens& lens, cv::Size size_px);

  /// Of the rectified pictures: the lens's principal point, and the mean of its focal lengths.
  const sim::Pinhole& camera() const { return camera_; }

  /// A lens without distortion and with square pixels leaves a picture as it is.
  void rectify(cv::Mat3b& picture) const;

 private:
  double covered() const;

  sim::Pinhole camera_;
  cv::Mat map_x_, map_y_;  ///< empty for a lens that is a pinhole
};

}  // namespace lcs::replay
