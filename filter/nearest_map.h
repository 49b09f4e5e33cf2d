/// \file
/// Which point lies nearest to a pixel: an image of indices, for many cheap look-ups about one set
/// of points. Answers to the pixel; `PointGrid` answers exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "filter/camera.h"

namespace lcs {

class NearestMap {
 public:
  NearestMap(int width_px, int height_px)
      : width_(width_px), height_(height_px), index_(std::size_t(width_px) * height_px, -1) {}

  /// \param radius_px up to which a point is found.
  void build(std::span<const Vec2> points, double radius_px) {
    for (const std::size_t pixel : touched_) index_[pixel] = -1;
    touched_.clear();
    const int reach = static_cast<int>(std::ceil(radius_px));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2& x = points[i];
      if (!inside(x)) continue;
      const int cx = static_cast<int>(std::lround(x.x())),
                cy = static_cast<int>(std::lround(x.y()));
      for (int v = std::max(0, cy - reach); v <= std::min(height_ - 1, cy + reach); ++v) {
        for (int u = std::max(0, cx - reach); u <= std::min(width_ - 1, cx + reach); ++u) {
          const double distance2 = (Vec2(u, v) - x).squaredNorm();
          if (distance2 > radius_px * radius_px) continue;
          std::int32_t& here = index_[std::size_t(v) * width_ + u];
          if (here < 0) {
            touched_.push_back(std::size_t(v) * width_ + u);
          } else if ((Vec2(u, v) - points[here]).squaredNorm() <= distance2) {
            continue;
          }
          here = static_cast<std::int32_t>(i);
        }
      }
    }
  }

  /// Index of the nearest point, -1: none near.
  int at(const Vec2& x) const {
    if (!inside(x)) return -1;
    return index_[std::size_t(std::lround(x.y())) * width_ + std::size_t(std::lround(x.x()))];
  }

 private:
  bool inside(const Vec2& x) const {
    return x.x() > -0.5 && x.y() > -0.5 && x.x() < width_ - 0.5 && x.y() < height_ - 0.5;
  }

  int width_, height_;
  std::vector<std::int32_t> index_;
  std::vector<std::size_t> touched_;
};

}  // namespace lcs
