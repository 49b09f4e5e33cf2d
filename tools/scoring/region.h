/// \file
/// The pixels that an object or a square covers, and how much two such regions overlap.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/mask.h"
#include "tools/recording/box.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// Pixels of one column, [top, bottom).
struct Stretch {
  int column = 0, top = 0, bottom = 0;
};

/// Ordered by column, and by row within a column; stretches do not touch.
struct Region {
  std::vector<Stretch> stretches;
  std::int64_t pixels = 0;
};

Region region_of(const sim::Mask& mask);

/// Pixels whose centre is within or on the rim, to a millionth of a pixel. Of a polygon that is not
/// convex each column is covered from its uppermost point to its lowest. Pixels farther out than
/// any picture reaches are left out.
///@{
Region region_of(const Outline& outline);
Region region_of(const Box& box);
///@}

/// What a square covers: its mask, if there is none its outline, if there is none its box.
Region region_of(const Square& square, const SquareMasks& masks);

double intersection_over_union(const Region& a, const Region& b);

}  // namespace lcs::bench
