/// \file
/// What the tests of the edges with two hypotheses share.
#pragma once

#include "filter/edges/edge_parameters.h"
#include "filter/edges/gauss.h"
#include "filter/kinematics/camera.h"
#include "tests/filter/scalar_track.h"

namespace lcs::testing {

inline constexpr double kNoise2_px2 = 0.36;
inline constexpr double kDt_s = 0.1;

inline const EdgeParameters kUsual = EdgeParameters{};

/// Density of a sighting without bounds on depth, 1/px^2.
inline double density(const StaticPoint& point, const Vec2& x_px, double noise2_px2) {
  return gauss(x_px - point.place_px, point.spread(noise2_px2));
}

}  // namespace lcs::testing
