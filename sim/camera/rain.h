/// \file
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
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/camera/illumination.h"
#include "sim/pose.h"
#include "sim/random.h"

namespace lcs::sim {

/// A drop on the window.
struct LensDrop {
  cv::Point2f centre_px;
  float radius_px = 0;
};

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

}  // namespace lcs::sim
