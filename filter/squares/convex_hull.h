/// \file
/// The outline of a square: the convex hull of where its edges are.
#pragma once

#include <utility>
#include <vector>

#include "filter/layers.h"

namespace lcs {

class ConvexHull {
 public:
  /// Begins a new one.
  void clear() { points_.clear(); }
  void add(const Vec2& point) { points_.push_back(point); }

  /// The least and the largest of the box that holds all points, of which there must be some.
  std::pair<Vec2, Vec2> box() const;

  /// The hull of the points, by Andrew's monotone chain: the same in whatever order they came. Of
  /// more vertices than an outline has room for it has those that reach farthest in as many
  /// directions, evenly spread.
  Outline outline();

 private:
  void make_chain();

  // Kept for their memory.
  std::vector<Vec2> points_, chain_;
};

/// Moves and stretches a square's box, and its outline with it: each vertex keeps its place within
/// the box.
void place(Square& square, const Vec2& location, const Vec2& half_size);

}  // namespace lcs
