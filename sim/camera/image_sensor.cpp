#include "sim/camera/image_sensor.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/random.h"

namespace lcs::sim {
namespace {

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

ImageSensor::ImageSensor(const scenario::Image& image, std::uint64_t scenario_seed)
    : noise_(image.noise), seed_(scenario_seed) {
  if (image.noise) normals_ = draw_normals(scenario_seed);
}

void ImageSensor::expose(cv::Mat3f& picture, const Exposure& exposure, int k) const {
  const auto light = static_cast<float>(exposure.time_s / scenario::Image::kDaylightExposure_s);
  const auto gain = static_cast<float>(exposure.gain);
  for (cv::Vec3f& pixel : picture) pixel *= light;
  if (noise_) add_noise(picture, k);
  for (cv::Vec3f& pixel : picture) {
    for (int c = 0; c < 3; ++c) pixel[c] = gain * std::min(pixel[c], 1.F);
  }
}

void ImageSensor::add_noise(cv::Mat3f& picture, int k) const {
  RandomStream random(seed_, "image.noise." + std::to_string(k));
  const auto full_well = static_cast<float>(noise_->full_well_e);
  const auto read_variance =
      static_cast<float>(noise_->read_e * noise_->read_e) / (full_well * full_well);
  for (cv::Vec3f& pixel : picture) {
    const std::uint64_t bits = random.bits();
    for (int c = 0; c < 3; ++c) {
      const float normal = normals_[(bits >> (16 * c)) & (kNormals - 1)];
      pixel[c] += std::sqrt(pixel[c] / full_well + read_variance) * normal;
    }
  }
}

}  // namespace lcs::sim
