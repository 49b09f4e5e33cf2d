/// \file
/// Depth maps in KITTI's format.
#pragma once

#include <opencv2/core.hpp>

namespace lcs::sequence {

inline constexpr float kKittiDepthScale = 256;  ///< codes per metre

/// Rounds to the nearest 1/256 m; 0 means no depth: the sky, and anything beyond 255.99 m.
cv::Mat1w kitti_depth(const cv::Mat1f& depth_m);

}  // namespace lcs::sequence
