/// \file
/// A camera's sensor: exposure, shot noise, read noise, gain.
///
/// A white surface in daylight fills a pixel in 1 ms. At linear light L and exposure t a pixel
/// collects n = full_well L t / 1 ms electrons and reads n + sqrt(n + read^2) N(0, 1), at most
/// full_well: photon counts have a variance equal to their mean. The gain multiplies signal and
/// noise. Each colour channel of each pixel has its own noise.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/camera/exposure_control.h"

namespace lcs::sim {

class ImageSensor {
 public:
  ImageSensor(const scenario::Image& image, std::uint64_t scenario_seed);

  /// Exposes the image of frame `k` in place, in linear light; the result is not yet clipped at 1.
  void expose(cv::Mat3f& picture, const Exposure& exposure, int k) const;

 private:
  void add_noise(cv::Mat3f& picture, int k) const;

  std::optional<scenario::Image::Noise> noise_;
  std::uint64_t seed_;
  std::vector<float> normals_;  ///< standard normal samples, drawn once; each pixel picks at random
};

}  // namespace lcs::sim
