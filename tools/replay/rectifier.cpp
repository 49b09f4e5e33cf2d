#include "tools/replay/rectifier.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace lcs::replay {
namespace {

constexpr double kLeastCovered = 0.1;

}  // namespace

Rectifier::Rectifier(const Lens& lens, cv::Size size_px)
    : camera_{0.5 * (lens.fu_px + lens.fv_px),
              {lens.cu_px, lens.cv_px},
              size_px.width,
              size_px.height} {
  const bool is_straight = std::all_of(lens.coefficients.begin(), lens.coefficients.end(),
                                       [](double c) { return c == 0; });
  const bool is_equidistant = lens.distortion == Lens::Distortion::equidistant;
  if (lens.fu_px == lens.fv_px && is_straight && !is_equidistant) return;
  const cv::Matx33d from(lens.fu_px, 0, lens.cu_px, 0, lens.fv_px, lens.cv_px, 0, 0, 1);
  const cv::Matx33d to(camera_.focal_px, 0, lens.cu_px, 0, camera_.focal_px, lens.cv_px, 0, 0, 1);
  const cv::Mat coefficients(lens.coefficients, true);
  if (is_equidistant) {
    cv::fisheye::initUndistortRectifyMap(from, coefficients, cv::Matx33d::eye(), to, size_px,
                                         CV_32FC1, map_x_, map_y_);
  } else {
    cv::initUndistortRectifyMap(from, coefficients, cv::Matx33d::eye(), to, size_px, CV_32FC1,
                                map_x_, map_y_);
  }
  if (!(covered() >= kLeastCovered)) {
    throw scenario::Error(lens.source,
                          "by its intrinsics and distortion the lens sees less than a tenth of its "
                          "own picture; correct them");
  }
}

/// Pixels that have a place in the picture that was taken, as a share of all.
double Rectifier::covered() const {
  int inside = 0;
  for (int y = 0; y < map_x_.rows; ++y) {
    for (int x = 0; x < map_x_.cols; ++x) {
      const float u = map_x_.at<float>(y, x), v = map_y_.at<float>(y, x);
      inside += u >= 0 && v >= 0 && u <= static_cast<float>(map_x_.cols - 1) &&
                v <= static_cast<float>(map_x_.rows - 1);
    }
  }
  return inside / static_cast<double>(map_x_.total());
}

void Rectifier::rectify(cv::Mat3b& picture) const {
  if (map_x_.empty()) return;
  cv::Mat3b straight;
  cv::remap(picture, straight, map_x_, map_y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  picture = straight;
}

}  // namespace lcs::replay
