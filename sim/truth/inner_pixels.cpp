#include "sim/truth/inner_pixels.h"

#include <opencv2/imgproc.hpp>

namespace lcs::sim {

cv::Mat1b inner_pixels(const cv::Mat1i& geom) {
  cv::Mat1f ids, least, most;
  geom.convertTo(ids, CV_32F);
  cv::erode(ids, least, {});
  cv::dilate(ids, most, {});
  cv::Mat1b inner;
  cv::compare(least, most, inner, cv::CMP_EQ);
  return inner;
}

}  // namespace lcs::sim
