#include "sim/camera/illumination.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace lcs::sim {
namespace {

/// Closer than this, the light of the lamps stays constant, because lamps are not points.
constexpr float kNearestLamp_m = 0.3F;
/// Reflectance of dense fog.
constexpr float kAirlight = 0.5F;
constexpr double kKoschmieder = 3.912;  // -log(0.02)
/// Standard deviation of a pixel's area along an axis: depth is of a pixel's middle, and lamps and
/// air of an outline's pixel are a mean over its area, as its colour is.
constexpr double kEdgeBlur_px = 1 / (2 * std::numbers::sqrt3);

/// The slope at b: the smaller difference, as the other neighbour may be on another surface.
float slope(float a, float b, float c) {
  const float before = b - a;
  const float after = c - b;
  return std::abs(before) < std::abs(after) ? before : after;
}

}  // namespace

Illumination::Illumination(const scenario::Image& image, const Optics& camera)
    : camera_(camera),
      ambient_(static_cast<float>(image.light_lx / scenario::Image::kDaylight_lx)),
      extinction_per_m_(image.visibility_m ? static_cast<float>(kKoschmieder / *image.visibility_m)
                                           : 0.F),
      ray_length_(camera.size_px()) {
  if (image.headlights) lamps_times_m2_.create(ray_length_.size());
  for (int y = 0; y < ray_length_.rows; ++y) {
    for (int x = 0; x < ray_length_.cols; ++x) {
      const Eigen::Vector3d ray = camera.ray(x, y).homogeneous();
      ray_length_(y, x) = static_cast<float>(ray.norm());
      if (!image.headlights) continue;
      const double off_axis = std::atan(ray.head<2>().norm()) / image.headlights->beam_rad;
      lamps_times_m2_(y, x) =
          static_cast<float>(image.headlights->intensity_cd / scenario::Image::kDaylight_lx *
                             std::exp(-off_axis * off_axis / 2));
    }
  }
}

float Illumination::lamps(int x, int y, float distance_m) const {
  if (lamps_times_m2_.empty()) return 0;
  const float d = std::max(distance_m, kNearestLamp_m);
  return lamps_times_m2_(y, x) / (d * d);
}

/// cos(alpha) of each pixel. On a plane n . X = h, a pixel with ray r has the inverse depth
/// w = (n . r) / h. The slopes of w by the ray give n / h; then cos(alpha) = w / (|n / h| |r|).
cv::Mat1f Illumination::facing(const cv::Mat1f& depth_m) const {
  cv::Mat1f cosine(depth_m.size(), 1.F);
  const Lens& lens = camera_.lens();
  const auto ray_of = [&](int x, int y) -> Eigen::Vector2f {
    if (!camera_.is_pinhole()) return camera_.ray(x, y).cast<float>();
    return Eigen::Vector2d(x - lens.cu_px, y - lens.cv_px).cast<float>() /
           static_cast<float>(lens.fu_px);
  };
  const auto inverse = [&](int x, int y) { return 1 / depth_m(y, x); };
  for (int y = 1; y + 1 < depth_m.rows; ++y) {
    for (int x = 1; x + 1 < depth_m.cols; ++x) {
      const float w = inverse(x, y);
      if (w <= 0) continue;  // the sky
      const Eigen::Vector2f by_px(slope(inverse(x - 1, y), w, inverse(x + 1, y)),
                                  slope(inverse(x, y - 1), w, inverse(x, y + 1)));
      const Eigen::Vector2f r = ray_of(x, y);
      const Eigen::Vector2f n =
          camera_.jacobian_px(r.cast<double>()).cast<float>().transpose() * by_px;
      const float nz = w - n.x() * r.x() - n.y() * r.y();
      const float length = std::sqrt(n.x() * n.x() + n.y() * n.y() + nz * nz);
      cosine(y, x) = std::min(1.F, w / (length * ray_length_(y, x)));
    }
  }
  // the outermost pixels have no neighbour on one side: they face as the next ones do
  cv::copyMakeBorder(cosine(cv::Rect(1, 1, cosine.cols - 2, cosine.rows - 2)).clone(), cosine, 1, 1,
                     1, 1, cv::BORDER_REPLICATE);
  return cosine;
}

void Illumination::light(cv::Mat3f& picture, const cv::Mat1f& depth_m) const {
  if (!depends_on_depth()) {
    if (ambient_ == 1) return;
    for (cv::Vec3f& pixel : picture) pixel *= ambient_;
    return;
  }
  const cv::Mat1f cosine = lamps_times_m2_.empty() ? cv::Mat1f() : facing(depth_m);
  cv::Mat1f lit(picture.size());
  cv::Mat1f clear(picture.size());  // transmittance of the air
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const float distance = depth_m(y, x) * ray_length_(y, x);
      lit(y, x) = ambient_;
      if (!cosine.empty()) lit(y, x) += cosine(y, x) * lamps(x, y, distance);
      clear(y, x) = extinction_per_m_ > 0 ? std::exp(-extinction_per_m_ * distance) : 1.F;
    }
  }
  if (!lamps_times_m2_.empty()) cv::GaussianBlur(lit, lit, {}, kEdgeBlur_px);
  if (extinction_per_m_ > 0) cv::GaussianBlur(clear, clear, {}, kEdgeBlur_px);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const float air = (1 - clear(y, x)) * kAirlight * ambient_;
      picture(y, x) = picture(y, x) * (lit(y, x) * clear(y, x)) + cv::Vec3f(air, air, air);
    }
  }
}

}  // namespace lcs::sim
