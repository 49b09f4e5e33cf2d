/// \file
/// Optical flow in the formats of KITTI and Middlebury, and depth maps in KITTI's.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

namespace lcs::sequence {

/// \name KITTI: u = (code - 2^15) / 64, in steps of 1/64 px up to 512 px.
///@{
inline constexpr float kKittiFlowScale = 64;
inline constexpr float kKittiFlowZero = 32768;
///@}

/// Middlebury's code for unknown flow: any value beyond 1e9.
inline constexpr float kMiddleburyUnknown = 1e10F;

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

/// The motion of each pixel in KITTI's encoding.
cv::Mat3w kitti_flow(const cv::Mat2f& motion_px, const cv::Mat1b& valid);

/// \return the bytes of a .flo file.
std::string middlebury_flow(const cv::Mat2f& motion_px);

inline constexpr float kKittiDepthScale = 256;  ///< codes per metre

/// Rounds to the nearest 1/256 m; 0 means no depth: the sky, and anything beyond 255.99 m.
cv::Mat1w kitti_depth(const cv::Mat1f& depth_m);

}  // namespace lcs::sequence
