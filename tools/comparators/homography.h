/// \file
/// The comparator `homography`: maps the image of a baseline ago to this one by a single
/// homography, fitted to the tracked corners by RANSAC. Outliers move by themselves. Uses no IMU.
/// Valid for a far or flat world and for a camera that only rotates, as most published code for
/// moving cameras assumes.
#pragma once

#include "tools/bench/detector.h"
#include "tools/comparators/backward_flow.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

struct HomographyParameters {
  FlowParameters flow;
  int least_corners = 8;      ///< fewest tracked corners for a fit, >= 4; else no corner is off
  double inlier_px = 0.7;     ///< RANSAC: largest distance of an inlier
  int max_iterations = 2000;  ///< of RANSAC
  double confidence = 0.995;
  double residual_px = 2;  ///< largest distance of a static corner from its mapped place
  GroupParameters groups;
};

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

}  // namespace lcs::comparators
