/// \file
/// Which of a constellation's points may hit: a screen before exact look-ups of whether a place has
/// a point near it. An anchor and an arm that are each rounded to whole pixels are together wrong
/// by no more than a pixel in x and in y, so hits are widened by one pixel to every side, and what
/// is left of a look-up is one addition and one byte.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "filter/pixels.h"

namespace lcs {

class HitScreen {
 public:
  /// Longest arm.
  static constexpr double kLongestArm_px = 126;

  HitScreen(int width_px, int height_px)
      : pixels_{width_px, height_px},
        stride_(width_px + 2 * kMargin_px),
        may_hit_(static_cast<std::size_t>(stride_) *
                 static_cast<std::size_t>(height_px + 2 * kMargin_px)) {}

  /// \param points in and outside the image; only those inside are hit.
  /// \param radius_px up to which a point is near.
  void build(std::span<const Vec2> points, double radius_px) {
    for (const Run& run : marked_) std::fill_n(may_hit_.begin() + run.first, run.count, 0);
    marked_.clear();
    for (const Vec2& x : points) {
      if (!pixels_.contain(x)) continue;
      pixels_.visit_disc(x, radius_px, [&](int v, int first, int last) {
        for (int row = v - 1; row <= v + 1; ++row) {
          marked_.push_back({origin(first - 1, row), last - first + 3});
          std::fill_n(may_hit_.begin() + marked_.back().first, marked_.back().count, 1);
        }
      });
    }
  }

  /// An arm, to be added to an anchor.
  using Offset = std::ptrdiff_t;
  Offset offset(const Vec2& arm) const {
    const Offset down = nearest_pixel(arm.y() + kMargin_px) - kMargin_px;
    return down * stride_ + nearest_pixel(arm.x() + kMargin_px) - kMargin_px;
  }

  /// What an arm is added to; nullptr where the anchor is not in the image.
  const std::uint8_t* anchor(const Vec2& x) const {
    if (!pixels_.contain(x)) return nullptr;
    return may_hit_.data() + origin(nearest_pixel(x.x()), nearest_pixel(x.y()));
  }

  /// How many arms may hit.
  static int count(const std::uint8_t* anchor, std::span<const Offset> arms) {
    int count = 0;
#pragma GCC unroll 8  // as many as neighbours vote; what is left of each is one addition
    for (const Offset arm : arms) count += anchor[arm];
    return count;
  }

  /// Writes the indices of those that may, in order, to `hits`, which has room for one more.
  static void list(const std::uint8_t* anchor, std::span<const Offset> arms, std::uint8_t* hits) {
    for (std::size_t i = 0; i < arms.size(); ++i) {
      // Without a branch, which would often be guessed wrong.
      *hits = static_cast<std::uint8_t>(i);
      hits += anchor[arms[i]];
    }
  }

 private:
  /// About the image, so that no arm leads out of the bytes.
  static constexpr int kMargin_px = 128;

  /// Pixels of a row, side by side.
  struct Run {
    std::ptrdiff_t first;
    int count;
  };

  std::ptrdiff_t origin(int u, int v) const {
    return static_cast<std::ptrdiff_t>(v + kMargin_px) * stride_ + u + kMargin_px;
  }

  Pixels pixels_;
  int stride_;
  std::vector<std::uint8_t> may_hit_;  // 0 or 1
  std::vector<Run> marked_;
};

}  // namespace lcs
