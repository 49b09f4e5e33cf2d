/// \file
/// The filter's camera model: a pinhole with square pixels and no distortion.
///
/// Conventions of the whole filter: pixels with x right, y down, (0, 0) at the centre of the
/// top-left pixel; camera frame C with x right, y down, z forward; angles in radians, wrapped to
/// (-pi, pi]; times in seconds; image speeds in px/s.
#pragma once

#include <Eigen/Core>

namespace lcs {

using Vec2 = Eigen::Vector2d;

struct Intrinsics {
  double focal_px = 0;            ///< f
  Vec2 centre_px = Vec2::Zero();  ///< principal point c (the paper's O_I while v is along z)
  int width_px = 0;
  int height_px = 0;
};

/// Size of an image.
struct Pixels {
  int width_px;
  int height_px;

  /// Whether a location falls on a pixel of the image.
  bool contain(const Vec2& x) const {
    return x.x() > -0.5 && x.y() > -0.5 && x.x() < width_px - 0.5 && x.y() < height_px - 0.5;
  }
};

}  // namespace lcs
