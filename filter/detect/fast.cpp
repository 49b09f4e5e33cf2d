#include "filter/detect/fast.h"

#include <opencv2/features2d.hpp>
#include <stdexcept>
#include <string>

namespace lcs {

FastDetector::FastDetector(int threshold) : threshold_(threshold) {
  if (threshold < 1 || threshold > 254) {
    throw std::invalid_argument("FAST threshold must be 1 to 254 grey levels, not " +
                                std::to_string(threshold));
  }
}

std::vector<Eigen::Vector2f> FastDetector::detect(const cv::Mat1b& grey) const {
  const std::vector<cv::KeyPoint> keypoints = detect_scored(grey);
  std::vector<Eigen::Vector2f> corners;
  corners.reserve(keypoints.size());
  for (const cv::KeyPoint& keypoint : keypoints) {
    corners.emplace_back(keypoint.pt.x, keypoint.pt.y);
  }
  return corners;
}

std::vector<cv::KeyPoint> FastDetector::detect_scored(const cv::Mat1b& grey) const {
  std::vector<cv::KeyPoint> keypoints;
  cv::FAST(grey, keypoints, threshold_, /*nonmaxSuppression=*/true,
           cv::FastFeatureDetector::TYPE_9_16);
  return keypoints;
}

}  // namespace lcs
