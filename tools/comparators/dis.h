/// \file
/// The comparator `dis`: dense flow (Kroeger et al., "Fast Optical Flow using Dense Inverse
/// Search", 2016; OpenCV's) from this image to the one of a baseline ago, which the camera's
/// rotation is taken out of first. A static corner's flow must end on the epipolar segment; what
/// ends elsewhere moves by itself. As `klt`, but that a pixel's flow fits in with that of the
/// pixels round it.
#pragma once

#include <opencv2/video/tracking.hpp>

#include "tools/bench/detector.h"
#include "tools/comparators/epipolar.h"
#include "tools/comparators/lookback.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

struct DisParameters {
  double baseline_s = kBaseline_s;  ///< to the image that is compared with, about; >= 0
  double residual_px = kStatic_px;  ///< distance from the segment that a static corner may have
  GroupParameters groups;
};

class DisDetector : public bench::Detector {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit DisDetector(const Intrinsics& camera, const DisParameters& parameters = {});
  const FrameResult& step(const bench::DetectorInput& input) override;
  Diagnostics diagnostics() const override { return pictures_.diagnostics(); }

 private:
  Intrinsics camera_;
  DisParameters parameters_;
  Lookback<cv::Mat1b> pictures_;
  cv::Ptr<cv::DISOpticalFlow> flow_;
  RebelGroups groups_;
  cv::Mat1b derotated_;  // of the current frame; kept for their memory
  cv::Mat2f to_earlier_;
  std::vector<CornerMotion> motions_;
};

}  // namespace lcs::comparators
