/// \file
/// The camera as the filter sees it: a pinhole with square pixels and no distortion.
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

}  // namespace lcs
