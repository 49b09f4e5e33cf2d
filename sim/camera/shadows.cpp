#include "sim/camera/lens_renderer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sim/truth/inner_pixels.h"

namespace lcs::sim {
namespace {

/// Least difference of the share of light from pixel to pixel at the edge of a shadow.
constexpr float kShadowStep = 0.09F;
/// Differences of shares below this are rounding.
constexpr float kRounding = 1e-3F;

/// The share of its light that each pixel keeps in shadow.
cv::Mat1f shares_of(const cv::Mat3f& even, const cv::Mat3f& shaded) {
  const auto sum = [](const cv::Vec3f& light) { return light[0] + light[1] + light[2]; };
  cv::Mat1f share(even.size());
  std::transform(even.begin(), even.end(), shaded.begin(), share.begin(),
                 [&](const cv::Vec3f& lit, const cv::Vec3f& dark) {
                   return sum(lit) > 0 ? sum(dark) / sum(lit) : 1;
                 });
  return share;
}

void take_speckles_away(const cv::Mat3f& even, const cv::Mat1i& geom, const cv::Mat1b& inner,
                        cv::Mat3f& shaded) {
  constexpr int kReach_px = 2;
  const cv::Mat1f share = shares_of(even, shaded);
  cv::Mat1f least, most;  // of the whole window
  const cv::Mat window_of_ones = cv::Mat::ones(2 * kReach_px + 1, 2 * kReach_px + 1, CV_8U);
  cv::erode(share, least, window_of_ones);
  cv::dilate(share, most, window_of_ones);
  const cv::Rect picture({}, geom.size());
  std::vector<float> around;
  for (int y = 0; y < geom.rows; ++y) {
    for (int x = 0; x < geom.cols; ++x) {
      // usually the median cannot differ
      if (!inner(y, x) || most(y, x) - least(y, x) <= kRounding) continue;
      around.clear();
      const cv::Rect window =
          cv::Rect(x - kReach_px, y - kReach_px, 2 * kReach_px + 1, 2 * kReach_px + 1) & picture;
      for (int row = window.y; row < window.br().y; ++row) {
        for (int column = window.x; column < window.br().x; ++column) {
          if (inner(row, column) && geom(row, column) == geom(y, x)) {
            around.push_back(share(row, column));
          }
        }
      }
      const auto middle = around.begin() + std::ssize(around) / 2;
      std::nth_element(around.begin(), middle, around.end());
      if (std::abs(share(y, x) - *middle) > kRounding) shaded(y, x) = *middle * even(y, x);
    }
  }
}

}  // namespace

cv::Mat1b clean_shadows(const cv::Mat3f& even, const cv::Mat1i& geom, cv::Mat3f& shaded) {
  cv::Mat1b inner = inner_pixels(geom);
  inner.setTo(0, geom < 0);
  cv::rectangle(inner, cv::Rect({}, inner.size()), 0);  // the outermost lack neighbours
  take_speckles_away(even, geom, inner, shaded);
  const cv::Mat1f share = shares_of(even, shaded);
  cv::Mat1b edge(geom.size(), uchar{0});
  for (int y = 0; y < geom.rows; ++y) {
    for (int x = 0; x < geom.cols; ++x) {
      const cv::Point here(x, y);
      for (const cv::Point& there : {cv::Point(x + 1, y), cv::Point(x, y + 1)}) {
        if (there.x == geom.cols || there.y == geom.rows) continue;
        if (!inner(here) || !inner(there)) continue;
        if (std::abs(share(here) - share(there)) > kShadowStep) edge(here) = edge(there) = 1;
      }
    }
  }
  return edge;
}

}  // namespace lcs::sim
