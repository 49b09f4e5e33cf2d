/// \file
/// Where the corners of a frame were a baseline ago, by pyramidal Lucas-Kanade (Bouguet, "Pyramidal
/// Implementation of the Affine Lucas Kanade Feature Detector", 2000; OpenCV's).
///
/// A verdict on a corner is due in the corner's own frame, so the flow runs back from this frame's
/// corners to the earlier image. Tracking that one's corners ahead, as is common, would end on
/// points that are nobody's corners.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "filter/kinematics/camera.h"
#include "tools/comparators/lookback.h"

namespace lcs::comparators {

struct FlowParameters {
  double baseline_s = kBaseline_s;  ///< to the image that is compared with, about; >= 0
  int window_px = 15;               ///< side of the window that is matched; odd, >= 3
  int levels = 4;                   ///< of the pyramid, above the image itself; >= 0
  int max_iterations = 30;          ///< on each level
  double least_step_px = 0.01;      ///< at which iterations end
  double least_eigenvalue = 1e-4;   ///< of the window's gradients, as OpenCV normalises it
};

class BackwardFlow {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit BackwardFlow(const FlowParameters& parameters);

  /// To be called with every frame, in order.
  /// \param grey of this frame; all frames are of one size.
  /// \param motion since the last frame.
  /// \return the motion since the image that this frame is compared with; none in the first frame.
  const EgoMotion& see(const cv::Mat1b& grey, const EgoMotion& motion);

  /// For the frame that was seen last.
  /// \param guesses_px where each corner may have been; as many as corners.
  /// \return where it was; none where it is lost, and for all corners of the first frame. Valid
  ///   until the next call.
  std::span<const std::optional<Vec2>> track(std::span<const Eigen::Vector2f> corners_px,
                                             std::span<const Vec2> guesses_px);

  /// What was wrong with the motions that were told.
  const Diagnostics& diagnostics() const { return pyramids_.diagnostics(); }

 private:
  using Pyramid = std::vector<cv::Mat>;
  using Points = std::vector<cv::Point2f>;
  /// `there` holds guesses before, and what was found after.
  void lucas_kanade(const Pyramid& from, const Pyramid& to, const Points& here, Points& there,
                    std::vector<unsigned char>& found) const;

  FlowParameters parameters_;
  Lookback<Pyramid> pyramids_;

  // Of the current frame; kept for their memory.
  Points corners_, before_;
  std::vector<unsigned char> found_;
  std::vector<std::optional<Vec2>> result_;
};

}  // namespace lcs::comparators
