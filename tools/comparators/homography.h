/// \file
/// The comparator `homography`: the image of a baseline ago is laid over this one by a single
/// homography, fitted to the tracked corners by RANSAC; what does not fit moves by itself. No IMU;
/// right for a far or flat world and for a camera that only turns, which is what most published
/// code for moving cameras assumes.
#pragma once

#include "tools/bench/detector.h"
#include "tools/comparators/backward_flow.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

struct HomographyParameters {
  FlowParameters flow;
  int least_corners = 8;      ///< tracked, to fit a homography to, >= 4; fewer: nothing is told
  double inlier_px = 0.7;     ///< RANSAC: distance at which a corner supports a hypothesis
  int max_iterations = 2000;  ///< of RANSAC
  double confidence = 0.995;
  double residual_px = 2;  ///< distance from where the homography takes it that a corner may have
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
  std::vector<Vec2> guesses_;  // of the current frame; kept for their memory
  std::vector<cv::Point2d> before_, now_;
  std::vector<CornerMotion> motions_;
};

}  // namespace lcs::comparators
