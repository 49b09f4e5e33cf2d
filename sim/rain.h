/// \file
/// Rain: streaks of drops that fall before the camera, and drops that lie on the window before its
/// lens.
///
/// Falling drops: their number and sizes follow Marshall & Palmer (1948) for the rate of rain,
/// above 1 mm and within 3 m (the rest is too thin to show), their fall speed Atlas et al. (1973).
/// A drop covers a pixel for diameter / speed of the exposure, and so adds that share of its own
/// brightness (Garg & Nayar, "Vision and rain", IJCV 2007); it is blurred by an aperture of 2 mm
/// that is focused far away. Each frame draws new drops.
///
/// Drops on the window, 8 cm before the lens: they stay where they landed until they run off, and
/// others land elsewhere. Each shows the scene upside down, at a wide angle and blurred, as a ball
/// of water does, within a soft edge.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/illumination.h"
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
  /// \throws std::invalid_argument where more drops would be in sight than can be drawn.
  Rain(const scenario::Image::Rain& rain, double exposure_s, const Pinhole& camera,
       std::uint64_t scenario_seed);

  /// Streaks of frame `k` in front of what is farther away.
  /// \param picture in linear light, daylights.
  void add_streaks(cv::Mat3f& picture, const cv::Mat1f& depth_m, const Illumination& light,
                   int k) const;

  /// The drops on the window at a time. They depend on seed and time alone; increasing times are
  /// quickest.
  std::vector<LensDrop> lens_drops(double t_s);

  /// Draws the drops of a time over what the camera sees.
  void look_through_drops(cv::Mat3f& picture, double t_s);

 private:
  struct Streak;
  /// A place on the window, on which drops follow each other.
  struct Place {
    std::string name;
    RandomStream lives;
    double until_s;  ///< when the present drop runs off
    int generation;  ///< of the present drop
  };
  Place dry_place(int number) const;
  Streak draw_streak(RandomStream& random) const;

  scenario::Image::Rain rain_;
  double exposure_s_;
  Pinhole camera_;
  std::uint64_t seed_;
  double expected_ = 0;  ///< streaks in a frame
  std::vector<Place> places_;
  double places_s_ = 0;  ///< the time that they are of
};

}  // namespace lcs::sim
