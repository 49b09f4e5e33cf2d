/// \file
/// The pixels that an object or a square covers, and the overlap of two such regions.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/truth/mask.h"
#include "tools/recording/box.h"
#include "tools/recording/recording.h"

namespace lcs::scoring {

/// Pixels of one column, [top, bottom).
struct Stretch {
  int column = 0, top = 0, bottom = 0;
};

/// A set of pixels. The stretches are ordered by column, then by row, and do not touch.
struct Region {
  std::vector<Stretch> stretches;
  std::int64_t pixels = 0;
};

Region region_of(const sim::Mask& mask);

/// The pixels whose centre lies inside or within 1e-6 px of the rim. A polygon that is not convex
/// covers each column from its highest to its lowest point. Pixels beyond 2^15 are left out.
///@{
Region region_of(const Outline& outline);
Region region_of(const recording::Box& box);
///@}

/// The region of a square: its mask, otherwise its outline, otherwise its box.
Region region_of(const Square& square, const recording::SquareMasks& masks);

double intersection_over_union(const Region& a, const Region& b);

}  // namespace lcs::scoring
