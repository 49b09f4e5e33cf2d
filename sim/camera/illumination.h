/// \file
/// Illumination of the scene, and attenuation by air between scene and camera.
///
/// The rendered image is taken as the reflectance under even light. A surface at distance d, an
/// angle theta off the optical axis and tilted by alpha from the ray (Lambert), receives the light
///
///     E = light + I exp(-theta^2 / (2 beam^2)) cos(alpha) / d^2
///
/// It is seen through air of extinction beta = 3.912 / visibility (Koschmieder) as
///
///     L = E exp(-beta d) * reflectance + (1 - exp(-beta d)) * airlight
///
/// The lamps are at the camera. A beam from elsewhere would cast shadows. `light` is equal on
/// surfaces of every direction.
#pragma once

#include <opencv2/core.hpp>

#include "scenarios/scenario.h"
#include "sim/base/optics.h"

namespace lcs::sim {

class Illumination {
 public:
  Illumination(const scenario::Image& image, const Optics& camera);

  /// Whether the light of a surface depends on its depth.
  bool depends_on_depth() const { return !lamps_times_m2_.empty() || extinction_per_m_ > 0; }

  /// \param picture in linear light. \param depth_m along the optical axis; +inf for sky. Not read
  ///   unless `depends_on_depth`.
  void light(cv::Mat3f& picture, const cv::Mat1f& depth_m) const;

  /// Lamp light, in daylights, on a surface that faces the lamps `distance_m` from pixel (x, y).
  float lamps(int x, int y, float distance_m) const;
  /// Ambient light, in daylights.
  float ambient() const { return ambient_; }

 private:
  cv::Mat1f facing(const cv::Mat1f& depth_m) const;

  Optics camera_;
  float ambient_;
  float extinction_per_m_;
  cv::Mat1f ray_length_;      ///< ray length per metre of z-depth
  cv::Mat1f lamps_times_m2_;  ///< daylights at a distance of 1 m; empty without lamps
};

}  // namespace lcs::sim
