/// \file
/// FAST-9 corners (Rosten, Porter & Drummond, "Faster and Better", PAMI 2010) by OpenCV: the chi
/// that the Line expert begins with.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace lcs {

/// Nine contiguous pixels of the circle of 16 brighter or darker than the centre by the threshold,
/// non-maximum suppression on. Pure: the same image gives the same corners in the same order.
class FastDetector {
 public:
  /// \param threshold in grey levels, 1 to 254; none: each picture's own (`picture_noise.h`). A
  ///   contrast of 0.20, as the paper has it, is 51.
  /// \throws std::invalid_argument when out of that range.
  explicit FastDetector(std::optional<int> threshold);

  /// For this picture.
  int threshold(const cv::Mat1b& grey) const;

  /// \return corners in pixels, row by row from the top, left to right in a row.
  std::vector<Eigen::Vector2f> detect(const cv::Mat1b& grey) const;
  /// Likewise, by a threshold that is known.
  static std::vector<Eigen::Vector2f> detect(const cv::Mat1b& grey, int threshold);

  /// The same corners with OpenCV's score, the highest threshold at which each still is one.
  std::vector<cv::KeyPoint> detect_scored(const cv::Mat1b& grey) const;

 private:
  std::optional<int> threshold_;
};

}  // namespace lcs
