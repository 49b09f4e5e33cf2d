#include "sim/camera/photograph.h"

#include <algorithm>
#include <cmath>

#include "sim/camera/linear_light.h"
#include "sim/pictures/picture_file.h"

namespace lcs::sim {
namespace {

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
