/// \file
/// What the told rotation is off by, from tracks that are sure to stand: each says how far its
/// corner is from where it was expected.
#pragma once

#include <Eigen/Core>
#include <span>

#include "filter/camera.h"

namespace lcs {

/// A corner, and how far it is from where its track was expected, px.
struct Residual {
  Vec2 place_px, off_px;
};

/// \return a small rotation of the camera, rad; null where too few tell. Large residuals count
///   little: they are of wrong matches, and of what begins to move.
Eigen::Vector3d rotation_fix(const Intrinsics& camera, std::span<const Residual> residuals,
                             double noise2_px2);

/// What it does to a place, px.
Vec2 shift(const Intrinsics& camera, const Eigen::Vector3d& rotation_rad, const Vec2& x_px);

}  // namespace lcs
