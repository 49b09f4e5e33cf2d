/// \file
/// Turns a rendered picture into the camera's, as the section `image` of a scenario says: light and
/// air, rain, blur and the sensor, in the order in which light meets them, then compression. The
/// truth stays as it is: a corner on a raindrop counts as what lies behind the drop.
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

  /// Turns the rendered picture of frame `k` into the camera's. The result depends on the arguments
  /// alone; frames in order of time are quickest.
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
