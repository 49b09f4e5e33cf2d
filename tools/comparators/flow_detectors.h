/// \file
/// The comparators, which track corners to a picture of a baseline ago (README.md).
#pragma once

#include <opencv2/video/tracking.hpp>

#include "tools/bench/detector.h"
#include "tools/comparators/backward_flow.h"
#include "tools/comparators/epipolar.h"
#include "tools/comparators/lookback.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

struct KltParameters {
  FlowParameters flow;
  double residual_px = kStatic_px;  ///< largest distance of a static corner from the segment
  GroupParameters groups;
};

/// The comparator `klt`, a baseline of common methods with OpenCV and an IMU. Each corner is
/// tracked back to the image of a baseline ago. A static point lies on the epipolar segment there;
/// other corners move by themselves.
///
/// It gets the same camera motion and ground as the filter. It stores only images, and so decides
/// on two frames.
class KltDetector : public bench::Detector {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit KltDetector(const Intrinsics& camera, const KltParameters& parameters = {});
  const FrameResult& step(const bench::DetectorInput& input) override;
  Diagnostics diagnostics() const override { return flow_.diagnostics(); }

 private:
  Intrinsics camera_;
  KltParameters parameters_;
  BackwardFlow flow_;
  RebelGroups groups_;
  std::vector<Vec2> guesses_;  // scratch storage of the current frame
  std::vector<CornerMotion> motions_;
};

struct HomographyParameters {
  FlowParameters flow;
  int least_corners = 8;      ///< fewest tracked corners for a fit, >= 4; else no corner is off
  double inlier_px = 0.7;     ///< RANSAC: largest distance of an inlier
  int max_iterations = 2000;  ///< of RANSAC
  double confidence = 0.995;
  double residual_px = 2;  ///< largest distance of a static corner from its mapped place
  GroupParameters groups;
};

/// The comparator `homography`: maps the image of a baseline ago to this one by a single
/// homography, fitted to the tracked corners by RANSAC. Outliers move by themselves. Uses no IMU.
/// Valid for a far or flat world and for a camera that only rotates, as most published code for
/// moving cameras assumes.
class HomographyDetector : public bench::Detector {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit HomographyDetector(const HomographyParameters& parameters = {});
  const FrameResult& step(const bench::DetectorInput& input) override;
  Diagnostics diagnostics() const override { return flow_.diagnostics(); }

 private:
  HomographyParameters parameters_;
  BackwardFlow flow_;
  RebelGroups groups_;
  std::vector<Vec2> guesses_;  // scratch storage of the current frame
  std::vector<cv::Point2d> before_, now_;
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
