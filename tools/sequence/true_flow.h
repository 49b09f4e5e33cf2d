/// \file
/// Exact optical flow: the motion of every pixel's surface point from frame k to k+1, from its
/// depth and the poses of the camera and of its body.
#pragma once

#include <cstdint>
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

/// \name KITTI: u = (code - 2^15) / 64, in steps of 1/64 px up to 512 px.
///@{
inline constexpr float kKittiFlowScale = 64;
inline constexpr float kKittiFlowZero = 32768;
///@}

/// Channels u, v, valid, in this order; all 0 if invalid or too large for the format.
inline cv::Vec3w kitti_code(const cv::Vec2f& motion_px, bool is_valid) {
  // In double: a float with 16 integer bits has too few left for the rounding.
  const double u = static_cast<double>(motion_px[0]) * kKittiFlowScale + kKittiFlowZero;
  const double v = static_cast<double>(motion_px[1]) * kKittiFlowScale + kKittiFlowZero;
  constexpr double kMost = 65535;
  const bool fits = u >= 0 && u <= kMost && v >= 0 && v <= kMost;  // false for NaN
  if (!is_valid || !fits) return {0, 0, 0};
  // Positive and with few bits, so that adding a half is exact and rounds to the nearest.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  return {static_cast<std::uint16_t>(u + 0.5), static_cast<std::uint16_t>(v + 0.5), 1};
}

}  // namespace lcs::sequence
