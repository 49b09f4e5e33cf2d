/// \file
/// Optical flow that is known: the motion of every pixel's surface point from frame k to k+1, by
/// the depth under it and the poses of the camera and of the body that it belongs to.
#pragma once

#include <opencv2/core.hpp>

#include "sim/truth.h"

namespace lcs::sequence {

/// All in pixels, forward. NaN where no motion is defined: on the rover itself, which the camera
/// carries along, and for points that are in or behind the camera's plane at k+1. The sky is
/// infinitely far: it moves by the rotation alone.
struct TrueFlow {
  cv::Mat2f full_px;  ///< of the point carried by its body
  cv::Mat2f ego_px;   ///< of the same point held fixed in the world: the camera's own part
  /// 1 where the point is seen in frame k+1: within the image, and not hidden by something nearer.
  cv::Mat1b seen;
  /// 1 where the point held fixed is seen in frame k+1. On a moving body it says only whether the
  /// point is within the image, as the world in which the body stands still was never rendered.
  cv::Mat1b ego_seen;
};

/// \param next_depth_m,next_object of frame k+1, as `sim::FrameTruth` has them.
TrueFlow true_flow(const sim::Pinhole& camera, const sim::FrameTruth& truth,
                   const cv::Mat1f& next_depth_m, const cv::Mat1i& next_object);

}  // namespace lcs::sequence
