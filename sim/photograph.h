/// \file
/// What a camera makes of a rendered picture: light and air, rain, blur and the sensor, in the
/// order in which light meets them, and the compression of what arrives. The section `image` of a scenario. Truth is not touched: a
/// corner on a drop counts as what lies behind it.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "scenarios/scenario.h"
#include "sim/illumination.h"
#include "sim/image_sensor.h"
#include "sim/pose.h"
#include "sim/rain.h"

namespace lcs::sim {

class Photographer {
 public:
  Photographer(const scenario::Image& image, const Pinhole& camera, double rate_hz,
               std::uint64_t scenario_seed);

  /// Turns the rendered picture of frame `k` into the camera's. The same for the same arguments, in
  /// whatever order; quick in that of time.
  void develop(cv::Mat3b& picture, const cv::Mat1f& depth_m, int k);

 private:
  double blur_px_;
  std::optional<int> jpeg_quality_;
  double rate_hz_;
  Illumination illumination_;
  std::optional<Rain> rain_;
  ImageSensor sensor_;
};

}  // namespace lcs::sim
