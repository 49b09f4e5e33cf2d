/// \file
/// Optical flow as KITTI and Middlebury store it.
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

/// Middlebury: anything beyond 1e9 is unknown; this is what is written.
inline constexpr float kMiddleburyUnknown = 1e10F;

/// Channels u, v, valid, in this order; all 0 where not valid or too large for the format.
inline cv::Vec3w kitti_code(const cv::Vec2f& motion_px, bool is_valid) {
  // In double: a float of 16 whole bits has too few left for the rounding.
  const double u = static_cast<double>(motion_px[0]) * kKittiFlowScale + kKittiFlowZero;
  const double v = static_cast<double>(motion_px[1]) * kKittiFlowScale + kKittiFlowZero;
  constexpr double kMost = 65535;
  const bool fits = u >= 0 && u <= kMost && v >= 0 && v <= kMost;  // not so a NaN
  if (!is_valid || !fits) return {0, 0, 0};
  // Positive, and of few enough bits, so that adding a half is exact and rounds to the nearest.
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  return {static_cast<std::uint16_t>(u + 0.5), static_cast<std::uint16_t>(v + 0.5), 1};
}

/// The motion of each pixel as KITTI encodes it.
cv::Mat3w kitti_flow(const cv::Mat2f& motion_px, const cv::Mat1b& valid);

/// The bytes of a .flo file.
std::string middlebury_flow(const cv::Mat2f& motion_px);

}  // namespace lcs::sequence
