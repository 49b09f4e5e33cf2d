/// \file
/// FAST-9 corners (Rosten, Porter & Drummond, "Faster and Better", PAMI 2010) by OpenCV: the Line
/// expert's input chi.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace lcs {

/// FAST-9: nine contiguous pixels of the circle of 16 are brighter or darker than the centre by the
/// threshold; non-maximum suppression. Pure: one image always gives the same corners in one order.
class FastDetector {
 public:
  /// \param threshold in grey levels, 1 to 254; absent: computed for each picture
  ///   (`picture_noise.h`). The paper's contrast of 0.20 is 51.
  /// \throws std::invalid_argument when out of that range.
  explicit FastDetector(std::optional<int> threshold);

  /// The threshold used for this picture, grey levels.
  int threshold(const cv::Mat1b& grey) const;

  /// \return corners in pixels, row by row from the top, left to right in a row.
  std::vector<Eigen::Vector2f> detect(const cv::Mat1b& grey) const;
  /// The same with a given threshold.
  static std::vector<Eigen::Vector2f> detect(const cv::Mat1b& grey, int threshold);

  /// The same corners with OpenCV's score: the highest threshold that still detects the corner.
  std::vector<cv::KeyPoint> detect_scored(const cv::Mat1b& grey) const;

 private:
  std::optional<int> threshold_;
};

}  // namespace lcs
