/// \file
/// Depth as KITTI stores it.
#pragma once

#include <opencv2/core.hpp>

namespace lcs::sequence {

inline constexpr float kKittiDepthScale = 256;  ///< codes to a metre

/// To the nearest 1/256 m; 0 is no depth: the sky, and what is farther than 255.99 m.
cv::Mat1w kitti_depth(const cv::Mat1f& depth_m);

}  // namespace lcs::sequence
