/// \file
/// The outline of a square: the convex hull of its edges' places.
#pragma once

#include <utility>
#include <vector>

#include "filter/types/layers.h"

namespace lcs {

class ConvexHull {
 public:
  /// Removes all points.
  void clear() { points_.clear(); }
  void add(const Vec2& point) { points_.push_back(point); }

  /// Least and largest corner of the bounding box, px; needs at least one point.
  std::pair<Vec2, Vec2> box() const;

  /// The hull of the points, by Andrew's monotone chain, independent of their order. A hull with
  /// too many vertices is reduced to those farthest in `kMost` evenly spaced directions.
  Outline outline();

 private:
  void make_chain();

  // Scratch storage; members, so that a frame need not allocate.
  std::vector<Vec2> points_, chain_;
};

/// Expected size of a body over the range of its corners: `count` uniform samples of an interval
/// span (count - 1) / (count + 1) of it on average.
double beyond(std::size_t count);

/// Moves and scales a square's box with its outline: each vertex keeps its relative place.
void place(Square& square, const Vec2& location, const Vec2& half_size);

}  // namespace lcs
