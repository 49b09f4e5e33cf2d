/// \file
/// Light and air between the scene and the camera.
///
/// The rendered picture stands for the reflectance of what it shows, lit evenly. A surface at
/// distance d, an angle theta off the optical axis and turned by alpha from the ray (Lambert), then
/// is lit by
///
///     E = light + I exp(-theta^2 / (2 beam^2)) cos(alpha) / d^2
///
/// and seen through air of extinction beta = 3.912 / visibility (Koschmieder) as
///
///     L = E exp(-beta d) * reflectance + (1 - exp(-beta d)) * airlight
///
/// The lamps sit at the camera: a beam from elsewhere would cast shadows, which do not move with
/// the surfaces on which they lie, so that the truth would be wrong there. `light` falls alike on
/// surfaces of every direction.
#pragma once

#include <opencv2/core.hpp>

#include "scenarios/scenario.h"
#include "sim/pose.h"

namespace lcs::sim {

class Illumination {
 public:
  Illumination(const scenario::Image& image, const Pinhole& camera);

  /// \param picture in linear light; \param depth_m along the optical axis, +inf in the sky.
  void light(cv::Mat3f& picture, const cv::Mat1f& depth_m) const;

  /// Light of the lamps on a surface that faces them, `distance_m` away at a pixel, in daylights.
  float lamps(int x, int y, float distance_m) const;
  /// The light on the whole scene, in daylights.
  float ambient() const { return ambient_; }

 private:
  cv::Mat1f facing(const cv::Mat1f& depth_m) const;

  Pinhole camera_;
  float ambient_;
  float extinction_per_m_;
  cv::Mat1f ray_length_;      ///< distance along the ray for each metre of depth
  cv::Mat1f lamps_times_m2_;  ///< daylights at a distance of 1 m; empty without lamps
};

}  // namespace lcs::sim
