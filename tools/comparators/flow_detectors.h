/// \file
/// The comparators, which track corners to a picture of a baseline ago (README.md).
#pragma once

#include <opencv2/video/tracking.hpp>

#include "sim/pictures/media.h"
#include "tools/bench/detector.h"
#include "tools/comparators/epipolar.h"
#include "tools/comparators/lookback.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

struct KltParameters {
  double baseline_s = kBaseline_s;  ///< age of the image to compare with, about; >= 0
  int window_px = 15;               ///< side of the matched window; odd, >= 3
  int levels = 4;                   ///< pyramid levels above the image itself; >= 0
  int max_iterations = 30;          ///< on each level
  double least_step_px = 0.01;      ///< iterations end below this step
  double least_eigenvalue = 1e-4;   ///< of the window's gradients, normalised as in OpenCV
  double residual_px = kStatic_px;  ///< largest distance of a static corner from the segment
  GroupParameters groups = {};
};

/// The comparator `klt`, a baseline of common methods with OpenCV and an IMU. Each corner is
/// tracked back to the image of a baseline ago by pyramidal Lucas-Kanade (Bouguet, "Pyramidal
/// Implementation of the Affine Lucas Kanade Feature Detector", 2000; OpenCV's). A static point
/// lies on the epipolar segment there; other corners move by themselves.
///
/// A verdict belongs to a corner of the current frame, so the flow runs backwards from its corners
/// to the earlier image. Forward tracking would end at points that are no detected corners.
///
/// It gets the same camera motion and ground as the filter. It stores only images, and so decides
/// on two frames.
class KltDetector : public bench::Detector {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit KltDetector(const Intrinsics& camera, const KltParameters& parameters = {});
  const FrameResult& step(const bench::DetectorInput& input) override;
  Diagnostics diagnostics() const override { return pyramids_.diagnostics(); }

 private:
  Intrinsics camera_;
  KltParameters parameters_;
  const sim::OpticalFlow& flow_;
  Lookback<std::vector<cv::Mat>> pyramids_;
  RebelGroups groups_;
  std::vector<cv::Point2f> corners_, before_;  // scratch storage of the current frame
  std::vector<unsigned char> found_;
  std::vector<CornerMotion> motions_;
};

struct DisParameters {
  double baseline_s = kBaseline_s;  ///< age of the image to compare with, about; >= 0
  double residual_px = kStatic_px;  ///< largest distance of a static corner from the segment
  GroupParameters groups;
};

/// The comparator `dis`: dense flow (Kroeger et al., "Fast Optical Flow using Dense Inverse
/// Search", 2016; OpenCV's) from this image to one a baseline earlier, whose camera rotation is
/// removed first. A static corner's flow ends on the epipolar segment; other corners move by
/// themselves. Like `klt`, but a pixel's flow is smoothed with its neighbourhood.
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
  cv::Mat1b derotated_;  // scratch storage of the current frame
  cv::Mat2f to_earlier_;
  std::vector<CornerMotion> motions_;
};

}  // namespace lcs::comparators
