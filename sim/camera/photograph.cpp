#include "sim/camera/photograph.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "sim/camera/linear_light.h"
#include "sim/pictures/picture_file.h"

namespace lcs::sim {
namespace {

/// The middle weight and those on one side of it; all add up to 1.
std::vector<float> weights_of(double sigma_px) {
  const int reach = static_cast<int>(std::ceil(3 * sigma_px));
  std::vector<double> exact;
  double sum = 0;
  for (int k = 0; k <= reach; ++k) {
    exact.push_back(std::exp(-k * k / (2 * sigma_px * sigma_px)));
    sum += (k == 0 ? 1 : 2) * exact.back();
  }
  std::vector<float> weights;
  for (const double w : exact) weights.push_back(static_cast<float>(w / sum));
  return weights;
}

/// to = w0 of + sum of w_k (before_k + after_k), for `count` floats.
void weigh(const std::vector<float>& weights, const float* of, int count, float* to,
           const auto& beside) {
  for (int i = 0; i < count; ++i) to[i] = weights[0] * of[i];
  for (int k = 1; k < static_cast<int>(weights.size()); ++k) {
    const float w = weights[static_cast<std::size_t>(k)];
    const auto [before, after] = beside(k);
    for (int i = 0; i < count; ++i) to[i] += w * (before[i] + after[i]);
  }
}

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

/// The share of the light that passes the lens: 1 - loss (r / R)^2, with r the distance from the
/// principal point and R the distance of the farthest corner.
cv::Mat3f falloff_of(double loss, const Lens& lens) {
  cv::Mat3f falloff(lens.height_px, lens.width_px);
  const double far_x = std::max(lens.cu_px, lens.width_px - 1 - lens.cu_px);
  const double far_y = std::max(lens.cv_px, lens.height_px - 1 - lens.cv_px);
  for (int y = 0; y < falloff.rows; ++y) {
    for (int x = 0; x < falloff.cols; ++x) {
      const double dx = x - lens.cu_px, dy = y - lens.cv_px;
      const double r2 = (dx * dx + dy * dy) / (far_x * far_x + far_y * far_y);
      falloff(y, x) = cv::Vec3f::all(static_cast<float>(std::max(0.0, 1 - loss * r2)));
    }
  }
  return falloff;
}

/// An index of 16 bits. A frame needs a million normals, and 64 random bits give four indices.
constexpr std::size_t kNormals = 1 << 16;

/// Standard normal samples, shifted and scaled to mean 0 and variance 1 up to rounding.
std::vector<float> draw_normals(std::uint64_t seed) {
  RandomStream random(seed, "image.normals");
  std::vector<double> drawn(kNormals);
  double sum = 0;
  for (double& x : drawn) sum += x = random.normal();
  const double mean = sum / kNormals;
  double squares = 0;
  for (const double x : drawn) squares += (x - mean) * (x - mean);
  const double deviation = std::sqrt(squares / kNormals);
  std::vector<float> normals;
  for (const double x : drawn) normals.push_back(static_cast<float>((x - mean) / deviation));
  return normals;
}

}  // namespace

void spread_points(cv::Mat3f& light, double sigma_px) {
  if (sigma_px <= 0 || light.empty()) return;
  const std::vector<float> weights = weights_of(sigma_px);
  const int reach = static_cast<int>(weights.size()) - 1, count = 3 * light.cols;
  cv::Mat3f across(light.size());
  std::vector<cv::Vec3f> wide(static_cast<std::size_t>(light.cols + 2 * reach));
  const float* const first = wide.front().val + 3 * reach;
  for (int y = 0; y < light.rows; ++y) {
    const cv::Vec3f* row = light[y];
    std::copy_n(row, light.cols, wide.begin() + reach);
    std::fill_n(wide.begin(), reach, row[0]);
    std::fill_n(wide.end() - reach, reach, row[light.cols - 1]);
    weigh(weights, first, count, across[y]->val,
          [&](int k) { return std::pair(first - 3 * k, first + 3 * k); });
  }
  const auto row = [&](int y) {
    return static_cast<const float*>(across[std::clamp(y, 0, light.rows - 1)]->val);
  };
  for (int y = 0; y < light.rows; ++y) {
    weigh(weights, row(y), count, light[y]->val,
          [&](int k) { return std::pair(row(y - k), row(y + k)); });
  }
}

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

Photographer::Photographer(const scenario::Image& image, const Optics& camera, double rate_hz,
                           std::uint64_t scenario_seed)
    : spread_px_(std::hypot(image.point_spread_px, image.blur_px)),
      jpeg_quality_(image.jpeg_quality),
      rate_hz_(rate_hz),
      illumination_(image, camera),
      noise_(image.noise),
      seed_(scenario_seed),
      control_(image, 1 / rate_hz) {
  if (noise_) normals_ = draw_normals(scenario_seed);
  if (image.vignetting > 0) falloff_ = falloff_of(image.vignetting, camera.lens());
  if (image.rain) rain_.emplace(*image.rain, camera.lens().pinhole(), scenario_seed);
}

void Photographer::pass_lens(cv::Mat3f& light) const {
  spread_points(light, spread_px_);
  if (!falloff_.empty()) cv::multiply(light, falloff_, light);
}

cv::Mat1f Photographer::light(const cv::Mat3f& rendered, const cv::Mat1f& depth_m) const {
  cv::Mat3f light = rendered.clone();
  light += cv::Scalar::all(kReflectance);
  illumination_.light(light, depth_m);
  pass_lens(light);
  cv::Mat1f luminance;
  cv::transform(light, luminance, cv::Matx13f(0.0722F, 0.7152F, 0.2126F));
  return luminance;
}

Exposure Photographer::develop(cv::Mat3f light, const cv::Mat1f& depth_m, int k,
                               cv::Mat3b& picture) {
  const Exposure exposure = control_.next();
  illumination_.light(light, depth_m);
  if (rain_) {
    rain_->add_streaks(light, depth_m, illumination_, exposure.time_s, k);
    rain_->look_through_drops(light, k / rate_hz_);
  }
  pass_lens(light);
  expose(light, exposure, k);
  control_.see(light);
  to_codes(light, picture);
  if (jpeg_quality_) decode_jpeg(encode_jpeg(picture, *jpeg_quality_)).copyTo(picture);
  return exposure;
}

void Photographer::expose(cv::Mat3f& picture, const Exposure& exposure, int k) const {
  const auto light = static_cast<float>(exposure.time_s / scenario::Image::kDaylightExposure_s);
  const auto gain = static_cast<float>(exposure.gain);
  picture *= light;
  if (noise_) add_noise(picture, k);
  cv::min(picture.reshape(1), 1, picture.reshape(1));
  picture *= gain;
}

void Photographer::add_noise(cv::Mat3f& picture, int k) const {
  RandomStream random(seed_, "image.noise." + std::to_string(k));
  const auto full_well = static_cast<float>(noise_->full_well_e);
  const auto read_variance =
      static_cast<float>(noise_->read_e * noise_->read_e) / (full_well * full_well);
  cv::Mat1f deviation(1, 3 * picture.cols), normal(1, 3 * picture.cols);
  for (int y = 0; y < picture.rows; ++y) {
    float* drawn = normal[0];
    for (int x = 0; x < picture.cols; ++x) {
      const std::uint64_t bits = random.bits();
      for (int c = 0; c < 3; ++c) *drawn++ = normals_[(bits >> (16 * c)) & (kNormals - 1)];
    }
    float* const values = picture[y]->val;
    for (int i = 0; i < normal.cols; ++i) deviation(i) = values[i] / full_well + read_variance;
    cv::sqrt(deviation, deviation);
    for (int i = 0; i < normal.cols; ++i) values[i] += deviation(i) * normal(i);
  }
}

}  // namespace lcs::sim
