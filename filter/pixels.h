/// \file
/// The pixels of an image: which one a location falls on, and which lie within a radius of it.
#pragma once

#include <algorithm>
#include <cmath>

#include "filter/camera.h"

namespace lcs {

/// The nearest whole number of a coordinate > -0.5; a half is rounded up. What std::lround gives,
/// which on the x86-64 baseline is a call.
inline int nearest_pixel(double coordinate_px) {
  const int whole = static_cast<int>(coordinate_px);
  return whole + (coordinate_px - whole >= 0.5);
}

struct Pixels {
  int width_px;
  int height_px;

  bool contain(const Vec2& x) const {
    return x.x() > -0.5 && x.y() > -0.5 && x.x() < width_px - 0.5 && x.y() < height_px - 0.5;
  }

  /// Calls `visit(row, first, last)` for the run of pixels in each row whose centres lie within
  /// `radius_px` of x, a location in the image. Only the ends of a run are computed, and then held
  /// against the distance itself, whatever the root was rounded to.
  template <typename Visit>
  void visit_disc(const Vec2& x, double radius_px, Visit&& visit) const {
    const double radius2 = radius_px * radius_px;
    const int top = std::max(0, static_cast<int>(std::ceil(x.y() - radius_px)) - 1);
    const int bottom = std::min(height_px - 1, static_cast<int>(std::floor(x.y() + radius_px)) + 1);
    for (int v = top; v <= bottom; ++v) {
      const auto near = [&](int u) { return (Vec2(u, v) - x).squaredNorm() <= radius2; };
      const double across = v - x.y();
      if (across * across > radius2) continue;
      const double half = std::sqrt(radius2 - across * across);
      int first = std::max(0, static_cast<int>(std::ceil(x.x() - half)) - 1);
      int last = std::min(width_px - 1, static_cast<int>(std::floor(x.x() + half)) + 1);
      while (first <= last && !near(first)) ++first;
      while (first <= last && !near(last)) --last;
      if (first <= last) visit(v, first, last);
    }
  }
};

}  // namespace lcs
