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

  void build(const Discs& discs) {
    for (const Run& run : marked_) std::fill_n(may_hit_.begin() + run.first, run.count, 0);
    marked_.clear();
    const std::vector<Discs::Run>& runs = discs.runs();
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const auto& [row, first, last, point] = runs[i];
      const bool is_top = i == 0 || runs[i - 1].point != point;
      const bool is_bottom = i + 1 == runs.size() || runs[i + 1].point != point;
      const Discs::Run& above = is_top ? runs[i] : runs[i - 1];
      const Discs::Run& below = is_bottom ? runs[i] : runs[i + 1];
      if (is_top) mark(row - 1, first, last);
      mark(row, std::min({first, above.first, below.first}),
           std::max({last, above.last, below.last}));
      if (is_bottom) mark(row + 1, first, last);
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

  /// Pixels of a row, and the one on either side.
  void mark(int row, int first, int last) {
    marked_.push_back({origin(first - 1, row), last - first + 3});
    std::fill_n(may_hit_.begin() + marked_.back().first, marked_.back().count, 1);
  }

  std::ptrdiff_t origin(int u, int v) const {
    return static_cast<std::ptrdiff_t>(v + kMargin_px) * stride_ + u + kMargin_px;
  }

  Pixels pixels_;
  int stride_;
  std::vector<std::uint8_t> may_hit_;  // 0 or 1
  std::vector<Run> marked_;
};

}  // namespace lcs
