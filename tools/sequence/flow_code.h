/// \file
/// Optical flow as KITTI and Middlebury store it.
#pragma once

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
cv::Mat3w kitti_flow(const cv::Mat2f& motion_px, const cv::Mat1b& valid);

/// The bytes of a .flo file.
std::string middlebury_flow(const cv::Mat2f& motion_px);

}  // namespace lcs::sequence
