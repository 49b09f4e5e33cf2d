/// \file
/// Turns a rendered image into the camera's, by the scenario's section `image`: light and air,
/// rain, the lens's point spread, vignetting and the sensor, then compression. The truth is
/// unchanged: a corner on a raindrop counts as the surface behind the drop. A lens bends the scene,
/// but no streaks and drops.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/optics.h"
#include "sim/base/pose.h"
#include "sim/base/random.h"
#include "sim/camera/exposure_control.h"

namespace lcs::sim {

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

/// A drop on the window.
struct LensDrop {
  cv::Point2f centre_px;
  float radius_px = 0;
};

/// Rain: streaks of falling drops in front of the camera, and drops on the window in front of its
/// lens.
///
/// Falling drops: number and sizes follow Marshall & Palmer (1948), above 1 mm and within 3 m
/// (others are too thin to see); fall speeds follow Atlas et al. (1973). A drop covers a pixel for
/// diameter / speed of the exposure, and adds that share of its own brightness (Garg & Nayar,
/// "Vision and rain", IJCV 2007), blurred by an aperture of 2 mm that is focused at infinity. Each
/// frame draws new drops.
///
/// Drops on the window, 8 cm before the lens: each stays until it runs off; then a new drop lands
/// elsewhere. A drop shows the scene upside down, wide-angle and blurred, within a soft edge.
class Rain {
 public:
  /// \throws std::invalid_argument if more drops would be visible than can be drawn.
  Rain(const scenario::Image::Rain& rain, const Pinhole& camera, std::uint64_t scenario_seed);

  /// Draws the streaks of frame `k` in front of pixels that are farther away.
  /// \param picture in linear light, in daylights. \param exposure_s that the drops fall.
  void add_streaks(cv::Mat3f& picture, const cv::Mat1f& depth_m, const Illumination& light,
                   double exposure_s, int k) const;

  /// The drops on the window at time `t_s`. They depend on the seed and the time alone; increasing
  /// times are fastest.
  std::vector<LensDrop> lens_drops(double t_s);

  /// Draws the window drops of time `t_s` over the image.
  void look_through_drops(cv::Mat3f& picture, double t_s);

 private:
  struct Streak;
  /// A slot for one window drop at a time.
  struct Place {
    std::string name;
    RandomStream lives;
    double until_s;  ///< time at which the present drop runs off
    int generation;  ///< number of the present drop
  };
  Place dry_place(int number) const;
  Streak draw_streak(RandomStream& random, double exposure_s) const;

  scenario::Image::Rain rain_;
  Pinhole camera_;
  std::uint64_t seed_;
  double expected_ = 0;  ///< mean number of streaks per frame
  std::vector<Place> places_;
  double places_s_ = 0;  ///< time of the state in `places_`
};

/// Spreads linear light by the lens: the light of a point becomes a Gaussian. Even light stays
/// even; at the border the outermost pixels continue. The same bits on any machine.
/// \param sigma_px standard deviation along each axis; 0: nothing changes.
void spread_points(cv::Mat3f& light, double sigma_px);

class Photographer {
 public:
  Photographer(const scenario::Image& image, const Optics& camera, double rate_hz,
               std::uint64_t scenario_seed);

  /// The picture of frame `k`. It depends on the arguments alone, but with `auto_exposure` on all
  /// frames before, too; frames in order of time are fastest.
  /// \param light as rendered: linear, BGR. \param picture BGR codes.
  /// \return exposure and gain of this frame.
  Exposure develop(cv::Mat3f light, const cv::Mat1f& depth_m, int k, cv::Mat3b& picture);

  /// The luminance behind the lens, without rain, by the weights of Rec. 709, in daylights.
  /// `kReflectance` is added to the reflectance of all surfaces, as ESIM does: textures have 8
  /// bits, whose steps in dark surfaces are no large contrasts then.
  /// \param rendered linear light, BGR. \param depth_m not read unless `depends_on_depth`.
  cv::Mat1f light(const cv::Mat3f& rendered, const cv::Mat1f& depth_m) const;
  bool depends_on_depth() const { return illumination_.depends_on_depth(); }

 private:
  static constexpr float kReflectance = 1e-3F;
  void pass_lens(cv::Mat3f& light) const;

  /// The sensor: exposure, shot noise, read noise, gain. Exposes the image of frame `k` in place,
  /// in linear light; the result is not yet clipped at 1.
  ///
  /// A white surface in daylight fills a pixel in 1 ms. At linear light L and exposure t a pixel
  /// collects n = full_well L t / 1 ms electrons and reads n + sqrt(n + read^2) N(0, 1), at most
  /// full_well: photon counts have a variance equal to their mean. The gain multiplies signal and
  /// noise. Each colour channel of each pixel has its own noise.
  void expose(cv::Mat3f& picture, const Exposure& exposure, int k) const;
  void add_noise(cv::Mat3f& picture, int k) const;

  double spread_px_;  ///< standard deviation of the whole point spread
  std::optional<int> jpeg_quality_;
  double rate_hz_;
  Illumination illumination_;
  std::optional<Rain> rain_;
  cv::Mat3f falloff_;  ///< of the lens's light; empty: none
  std::optional<scenario::Image::Noise> noise_;
  std::uint64_t seed_;
  std::vector<float> normals_;  ///< standard normal samples, drawn once; each pixel picks at random
  ExposureControl control_;
};

}  // namespace lcs::sim
