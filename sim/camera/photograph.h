/// \file
/// Turns a rendered image into the camera's, by the scenario's section `image`: light and air,
/// rain, blur, vignetting and the sensor, then compression. The truth is unchanged: a corner on a
/// raindrop counts as the surface behind the drop. A lens bends the scene, but no streaks and
/// drops.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "scenarios/scenario.h"
#include "sim/camera/illumination.h"
#include "sim/camera/image_sensor.h"
#include "sim/camera/optics.h"
#include "sim/camera/rain.h"

namespace lcs::sim {

class Photographer {
 public:
  Photographer(const scenario::Image& image, const Optics& camera, double rate_hz,
               std::uint64_t scenario_seed);

  /// Converts the rendered image of frame `k` in place. The result depends on the arguments alone,
  /// but with `auto_exposure` on all frames before, too; frames in order of time are fastest.
  /// \return exposure and gain of this frame.
  Exposure develop(cv::Mat3b& picture, const cv::Mat1f& depth_m, int k);

  /// The light that a rendered image gives behind the lens, without rain: luminance by the weights
  /// of Rec. 709, in daylights. `kReflectance` is added to the reflectance of all surfaces, as ESIM
  /// does, so that the steps of 8 bits in dark surfaces are no large contrasts.
  /// \param depth_m not read unless `depends_on_depth`.
  cv::Mat1f light(const cv::Mat3b& picture, const cv::Mat1f& depth_m) const;
  bool depends_on_depth() const { return illumination_.depends_on_depth(); }

 private:
  static constexpr float kReflectance = 1e-3F;
  void pass_lens(cv::Mat3f& light) const;

  double blur_px_;
  std::optional<int> jpeg_quality_;
  double rate_hz_;
  Illumination illumination_;
  std::optional<Rain> rain_;
  cv::Mat3f falloff_;  ///< of the lens's light; empty: none
  ImageSensor sensor_;
  ExposureControl control_;
};

}  // namespace lcs::sim
