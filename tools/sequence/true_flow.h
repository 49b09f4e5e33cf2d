/// \file
/// Exact optical flow: the motion of every pixel's surface point from frame k to k+1, from its
/// depth and the poses of the camera and of its body.
#pragma once

#include <opencv2/core.hpp>

#include "sim/truth/truth.h"

namespace lcs::sequence {

/// Forward flow in pixels. NaN if undefined: on the rover itself, which moves with the camera, on
/// the sky, which has no depth, for points in or behind the camera plane at k+1, and for points
/// where the distortion has folded back.
struct TrueFlow {
  cv::Mat2f full_px;  ///< of the point, moving with its body
  cv::Mat2f ego_px;   ///< of the same point fixed in the world: the camera's own part
  /// 1 where the point is visible in frame k+1: within the image and not occluded.
  cv::Mat1b seen;
  /// 1 where the fixed point is visible in frame k+1. On a moving body: 1 within the image, because
  /// the world with a static body was never rendered.
  cv::Mat1b ego_seen;
};

/// The surfaces of a frame: `sim::Observation::geom`, or any other number of each surface.
struct Surfaces {
  const cv::Mat1f& depth_m;
  const cv::Mat1i& id;
};

/// \param surface_id of frame k. A point is visible in frame k+1 only on its own surface: a thin
/// body may have no pixel there, and the depth of the ground behind it may be like its own.
TrueFlow true_flow(const sim::Optics& camera, const sim::FrameTruth& truth,
                   const cv::Mat1i& surface_id, const Surfaces& next);

}  // namespace lcs::sequence
