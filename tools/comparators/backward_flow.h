/// \file
/// Tracks the corners of a frame back to an earlier image by pyramidal Lucas-Kanade (Bouguet,
/// "Pyramidal Implementation of the Affine Lucas Kanade Feature Detector", 2000; OpenCV's).
///
/// A verdict belongs to a corner of the current frame, so the flow runs backwards from its corners
/// to the earlier image. Forward tracking would end at points that are no detected corners.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "filter/kinematics/camera.h"
#include "sim/pictures/media.h"
#include "tools/comparators/lookback.h"

namespace lcs::comparators {

struct FlowParameters {
  double baseline_s = kBaseline_s;  ///< age of the image to compare with, about; >= 0
  int window_px = 15;               ///< side of the matched window; odd, >= 3
  int levels = 4;                   ///< pyramid levels above the image itself; >= 0
  int max_iterations = 30;          ///< on each level
  double least_step_px = 0.01;      ///< iterations end below this step
  double least_eigenvalue = 1e-4;   ///< of the window's gradients, normalised as in OpenCV
};

class BackwardFlow {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit BackwardFlow(const FlowParameters& parameters);

  /// Call with each frame, in order.
  /// \param grey image of this frame; all frames have one size.
  /// \param motion since the last frame.
  /// \return the motion since the image to compare with; zero in the first frame.
  const EgoMotion& advance(const cv::Mat1b& grey, const EgoMotion& motion);

  /// Tracks the corners of the last frame passed to `see`.
  /// \param guesses_px expected earlier place of each corner; as many as corners.
  /// \return earlier place of each corner; absent if lost, and for all corners of the first frame.
  ///   Valid until the next call.
  std::span<const std::optional<Vec2>> track(std::span<const Eigen::Vector2f> corners_px,
                                             std::span<const Vec2> guesses_px);

  /// Counts of the faults in the given motions.
  const Diagnostics& diagnostics() const { return pyramids_.diagnostics(); }

 private:
  const sim::OpticalFlow& flow_;
  FlowParameters parameters_;
  Lookback<std::vector<cv::Mat>> pyramids_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<cv::Point2f> corners_, before_;
  std::vector<unsigned char> found_;
  std::vector<std::optional<Vec2>> result_;
};

}  // namespace lcs::comparators
