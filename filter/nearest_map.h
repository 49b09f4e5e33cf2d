/// \file
/// Which point lies nearest to a pixel: an image of indices, for many cheap look-ups about one set
/// of points. Answers to the pixel; `PointGrid` answers exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "filter/pixels.h"
#include "filter/refill.h"

namespace lcs {

class NearestMap {
 public:
  NearestMap(int width_px, int height_px)
      : pixels_{width_px, height_px},
        index_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), -1),
        stride_(width_px + 2 * kMargin_px),
        is_near_(static_cast<std::size_t>(stride_) *
                 static_cast<std::size_t>(height_px + 2 * kMargin_px)) {}

  /// \param discs of these points: up to where each is found.
  void build(std::span<const Vec2> points, const Discs& discs) {
    for (const Discs::Run& run : touched_) {
      for (int u = run.first; u <= run.last; ++u) {
        index_[pixel(u, run.row)] = -1;
        is_near_[margin_pixel(u, run.row)] = 0;
      }
    }
    copy_over(discs.runs(), touched_);
    for (const auto& [v, first, last, i] : touched_) {
      for (int u = first; u <= last; ++u) {
        is_near_[margin_pixel(u, v)] = 1;
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

  /// A place, or the way from one to another, for many look-ups of sums: x in the lower half and y
  /// in the upper, whole numbers of a small share of a pixel. What lies farther than any image is
  /// wide is brought to that.
  using Steps = std::int64_t;
  static Steps place(const Vec2& x_px) { return way(x_px + Vec2::Constant(kMargin_px + 0.5)); }
  static Steps way(const Vec2& way_px) {
    const auto whole = [](double px) {
      return static_cast<Steps>(std::floor(std::clamp(px, -kFar_px, kFar_px) * kSteps + 0.5));
    };
    return (whole(way_px.y()) << 32) + whole(way_px.x());
  }

  /// What a look-up found.
  struct Found {
    int look_up, point;  ///< indices
  };

  /// Whether `count` may be asked for ways of this length at the most.
  bool can_count(const Vec2& from_px, double length_px) const {
    return pixels_.contain(from_px) && length_px < kMargin_px - 1;
  }

  /// How many of `from` + each of `ways` have a point near. Only where it `can_count`.
  int count(Steps from, std::span<const Steps> ways) const {
    int count = 0;
#pragma GCC unroll 8  // as many as neighbours vote
    for (const Steps way : ways) count += is_near_[margin_pixel(from + way)];
    return count;
  }

  /// Looks up `from` + each of `ways`. Writes what it finds, in order, to `found`, which has room
  /// for one more than there are ways. \return how much that is
  int find(Steps from, std::span<const Steps> ways, Found* found) const {
    int count = 0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      // Without a branch, which would often be guessed wrong.
      found[count] = {static_cast<int>(i), at(from + ways[i])};
      count += found[count].point >= 0;
    }
    return count;
  }

 private:
  static constexpr int kShift = 10;
  static constexpr std::int32_t kSteps = 1 << kShift;  // to a pixel
  static constexpr double kFar_px = 5e5;
  static constexpr int kMargin_px = 128;

  static double distance2(int u, int v, const Vec2& x) {
    return (Vec2(u, v) - x).squaredNorm();
  }
  std::ptrdiff_t margin_pixel(int u, int v) const {
    return (v + kMargin_px) * stride_ + u + kMargin_px;
  }
  std::ptrdiff_t margin_pixel(Steps place) const {
    return (place >> (32 + kShift)) * stride_ + (static_cast<std::uint32_t>(place) >> kShift);
  }
  std::int32_t at(Steps place) const {
    const std::int64_t u = (static_cast<std::int32_t>(place) >> kShift) - kMargin_px;
    const std::int64_t v = (place >> (32 + kShift)) - kMargin_px;
    if (u < 0 || v < 0 || u >= pixels_.width_px || v >= pixels_.height_px) return -1;
    return index_[pixel(u, v)];
  }
  std::ptrdiff_t pixel(std::int64_t u, std::int64_t v) const {
    return v * pixels_.width_px + u;
  }

  Pixels pixels_;
  std::vector<std::int32_t> index_;
  std::vector<Discs::Run> touched_;
  // Whether there is one: less memory to go through, and some more of it beyond the image's sides,
  // so that no way leads out of it.
  std::ptrdiff_t stride_;
  std::vector<std::uint8_t> is_near_;
};

}  // namespace lcs
