#include "filter/detect/fast.h"

#include <opencv2/features2d.hpp>
#include <stdexcept>
#include <string>

#include "filter/detect/picture_noise.h"

namespace lcs {
FastDetector::FastDetector(std::optional<int> threshold) : threshold_(threshold) {
  if (threshold && (*threshold < 1 || *threshold > 254)) {
    throw std::invalid_argument("FAST threshold must be 1 to 254 grey levels, not " +
                                std::to_string(*threshold));
  }
}

int FastDetector::threshold(const cv::Mat1b& grey) const {
  return threshold_ ? *threshold_ : threshold_of(grey);
}

std::vector<Eigen::Vector2f> FastDetector::detect(const cv::Mat1b& grey) const {
  return detect(grey, threshold(grey));
}

std::vector<Eigen::Vector2f> FastDetector::detect(const cv::Mat1b& grey, int threshold) {
  const std::vector<cv::KeyPoint> keypoints = FastDetector(threshold).detect_scored(grey);
  std::vector<Eigen::Vector2f> corners;
  corners.reserve(keypoints.size());
  for (const cv::KeyPoint& keypoint : keypoints) {
    corners.emplace_back(keypoint.pt.x, keypoint.pt.y);
  }
  return corners;
}

std::vector<cv::KeyPoint> FastDetector::detect_scored(const cv::Mat1b& grey) const {
  std::vector<cv::KeyPoint> keypoints;
  cv::FAST(grey, keypoints, threshold(grey), /*nonmaxSuppression=*/true,
           cv::FastFeatureDetector::TYPE_9_16);
  return keypoints;
}

}  // namespace lcs
