/// \file
/// The pixels of an image: which one a location falls on, and which lie within a radius of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

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
  /// `radius_px` of x, a location in the image. Only the ends of a run are computed, and held
  /// against the distance itself where the root might have been rounded across a pixel.
  template <typename Visit>
  void visit_disc(const Vec2& x, double radius_px, Visit&& visit) const {
    const double radius2 = radius_px * radius_px;
    const int top = std::max(0, Ends(x.y(), radius_px).first);
    const int bottom = std::min(height_px - 1, Ends(x.y(), radius_px).last);
    for (int v = top; v <= bottom; ++v) {
      const double across = v - x.y();
      const double rest = radius2 - across * across;
      if (rest < 0) continue;
      Ends run(x.x(), std::sqrt(rest));
      const auto near = [&](int u) { return (Vec2(u, v) - x).squaredNorm() <= radius2; };
      if (run.first_in_doubt && !near(run.first)) ++run.first;
      if (run.last_in_doubt && !near(run.last)) --run.last;
      const int first = std::max(0, run.first), last = std::min(width_px - 1, run.last);
      if (first <= last) visit(v, first, last);
    }
  }

 private:
  /// The whole numbers between centre - half and centre + half. Those that lie on an end but for
  /// what may be rounded are in, and in doubt.
  struct Ends {
    Ends(double centre, double half) {
      constexpr double kDoubt = 1e-6;
      const double low = centre - half - kDoubt, high = centre + half + kDoubt;
      first = static_cast<int>(low);
      first += low > first;
      last = static_cast<int>(high);
      last -= high < last;
      first_in_doubt = first - low < 2 * kDoubt;
      last_in_doubt = high - last < 2 * kDoubt;
    }
    int first, last;
    bool first_in_doubt, last_in_doubt;
  };
};

/// The pixels near each of some points, row by row: computed once, and painted into each map of the
/// points.
class Discs {
 public:
  struct Run {
    int row, first, last;
    int point;  // index
  };

  Discs(int width_px, int height_px) : pixels_{width_px, height_px} {}

  /// \param points in and outside the image; those outside are near to nothing.
  /// \param radius_px up to which a pixel is near.
  void build(std::span<const Vec2> points, double radius_px) {
    runs_.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!pixels_.contain(points[i])) continue;
      pixels_.visit_disc(points[i], radius_px, [&](int row, int first, int last) {
        runs_.push_back({row, first, last, static_cast<int>(i)});
      });
    }
  }

  const std::vector<Run>& runs() const { return runs_; }

 private:
  Pixels pixels_;
  std::vector<Run> runs_;
};

}  // namespace lcs
