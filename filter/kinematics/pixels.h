/// \file
/// The pixels of an image, and whether a location falls on one of them.
#pragma once

#include "filter/kinematics/camera.h"

namespace lcs {

struct Pixels {
  int width_px;
  int height_px;

  bool contain(const Vec2& x) const {
    return x.x() > -0.5 && x.y() > -0.5 && x.x() < width_px - 0.5 && x.y() < height_px - 0.5;
  }
};

}  // namespace lcs
