/// \file
/// A camera's sensor: exposure, shot noise, read noise, gain.
///
/// A white surface in daylight fills a pixel in 1 ms. At linear light L and exposure t a pixel
/// collects n = full_well L t / 1 ms electrons, of which it counts n + sqrt(n + read^2) N(0, 1),
/// full_well at most: photons come at random, with a variance equal to their number. The gain then
/// multiplies signal and noise alike. Each colour of each pixel draws its own noise.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::sim {

class ImageSensor {
 public:
  ImageSensor(const scenario::Image& image, std::uint64_t scenario_seed);

  /// The picture of frame `k`, in place, in linear light; still to be clipped at 1.
  void expose(cv::Mat3f& picture, int k) const;

 private:
  void add_noise(cv::Mat3f& picture, int k) const;

  scenario::Image image_;
  std::uint64_t seed_;
  std::vector<float> normals_;  ///< drawn once and then picked from at random
};

}  // namespace lcs::sim
