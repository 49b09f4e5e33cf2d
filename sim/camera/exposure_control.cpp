#include "sim/camera/exposure_control.h"

#include <algorithm>
#include <cmath>

namespace lcs::sim {
namespace {

constexpr double kDarkest = 1e-5;  // least mean, so that a black picture has a logarithm

double mean_of(const cv::Mat3f& exposed) {
  double sum = 0;
  for (const cv::Vec3f& pixel : exposed) {
    for (int c = 0; c < 3; ++c) sum += std::clamp(pixel[c], 0.F, 1.F);
  }
  return sum / (3.0 * static_cast<double>(exposed.total()));
}

}  // namespace

ExposureControl::ExposureControl(const scenario::Image& image, double period_s)
    : control_(image.auto_exposure), next_{image.exposure_s, image.gain} {
  if (!control_) return;
  exposure_s_ = control_->exposure_s.value_or(Eigen::Vector2d::Constant(image.exposure_s));
  const double tau_s = control_->time_constant_s;
  share_ = tau_s > 0 ? -std::expm1(-period_s / tau_s) : 1;
}

void ExposureControl::see(const cv::Mat3f& exposed) {
  if (!control_) return;
  const double mean = std::max(mean_of(exposed), kDarkest);
  const double product =
      next_.time_s * next_.gain * std::exp(share_ * std::log(control_->target / mean));
  const Eigen::Vector2d& gain = control_->gain;
  next_.time_s = std::clamp(product / gain[0], exposure_s_[0], exposure_s_[1]);
  next_.gain = std::clamp(product / next_.time_s, gain[0], gain[1]);
}

}  // namespace lcs::sim
