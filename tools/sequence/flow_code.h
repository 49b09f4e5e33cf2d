/// \file
/// Optical flow and depth in KITTI's formats.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace lcs::sequence {

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

inline constexpr float kKittiDepthScale = 256;  ///< codes per metre

}  // namespace lcs::sequence
