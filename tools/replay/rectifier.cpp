#include "tools/replay/rectifier.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace lcs::replay {

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
}

void Rectifier::rectify(cv::Mat3b& picture) const {
  if (map_x_.empty()) return;
  cv::Mat3b straight;
  cv::remap(picture, straight, map_x_, map_y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  picture = straight;
}

}  // namespace lcs::replay
