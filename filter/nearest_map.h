/// \file
/// Which point lies nearest to a pixel: an image of indices, for many cheap look-ups about one set
/// of points. Answers to the pixel; `PointGrid` answers exactly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "filter/pixels.h"

namespace lcs {

class NearestMap {
 public:
  NearestMap(int width_px, int height_px)
      : pixels_{width_px, height_px},
        index_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), -1) {}

  /// \param discs of these points: up to where each is found.
  void build(std::span<const Vec2> points, const Discs& discs) {
    for (const Run& run : touched_) std::fill_n(index_.begin() + run.first, run.count, -1);
    touched_.clear();
    for (const auto& [v, first, last, i] : discs.runs()) {
      touched_.push_back({pixel(first, v), last - first + 1});
      for (int u = first; u <= last; ++u) {
        std::int32_t& here = index_[pixel(u, v)];
        if (here >= 0 && distance2(u, v, points[here]) <= distance2(u, v, points[i])) continue;
        here = i;
      }
    }
  }

  /// Index of the nearest point, -1: none near.
  int at(const Vec2& x) const {
    if (!pixels_.contain(x)) return -1;
    return index_[pixel(nearest_pixel(x.x()), nearest_pixel(x.y()))];
  }

 private:
  /// Pixels of a row, side by side.
  struct Run {
    std::ptrdiff_t first;
    int count;
  };

  static double distance2(int u, int v, const Vec2& x) { return (Vec2(u, v) - x).squaredNorm(); }
  std::ptrdiff_t pixel(int u, int v) const {
    return static_cast<std::ptrdiff_t>(v) * pixels_.width_px + u;
  }

  Pixels pixels_;
  std::vector<std::int32_t> index_;
  std::vector<Run> touched_;
};

}  // namespace lcs
