/// \file
/// Axis-aligned boxes in an image, in pixels; whole numbers are pixel centres, as for corners and
/// squares.
#pragma once

#include <Eigen/Geometry>

#include "filter/types/layers.h"
#include "sim/truth/truth.h"
#include "tools/recording/labels.h"

namespace lcs::recording {

using Box = Eigen::AlignedBox2d;

/// \name Conversion between pixel edges and pixel centres: pixels l to r-1 cover l - 1/2
/// to r - 1/2.
///@{
inline Box box_of(const sim::ObjectTruth& truth) {
  return {Vec2(truth.left - 0.5, truth.top - 0.5), Vec2(truth.right - 0.5, truth.bottom - 0.5)};
}
inline Box box_of(const LabelledBox& label) {
  return {Vec2(label.left - 0.5, label.top - 0.5), Vec2(label.right - 0.5, label.bottom - 0.5)};
}
/// \param corner left, top; \param size width, height.
inline Square square_of(Id id, const Vec2& corner, const Vec2& size) {
  Square square;
  square.id = id;
  square.location = corner + 0.5 * size - Vec2(0.5, 0.5);
  square.half_size = 0.5 * size;
  return square;
}
/// The bounding box of a mask.
inline Square square_of(const sim::Mask& mask, Id id) {
  return square_of(id, Vec2(mask.box.x, mask.box.y), Vec2(mask.box.width, mask.box.height));
}
/// \return left, top, right, bottom as pixel edges.
inline Eigen::Vector4d edges_of(const Square& square) {
  Eigen::Vector4d edges;
  edges << square.location - square.half_size, square.location + square.half_size;
  return edges.array() + 0.5;
}
///@}

inline Box box_of(const Square& square) {
  return {square.location - square.half_size, square.location + square.half_size};
}

/// Area of the intersection, in square pixels.
inline double common_px2(const Box& a, const Box& b) {
  return a.intersection(b).sizes().cwiseMax(0).prod();
}

inline double intersection_over_union(const Box& a, const Box& b) {
  const double common = common_px2(a, b);
  const double all = a.volume() + b.volume() - common;
  return all > 0 ? common / all : 0;
}

}  // namespace lcs::recording
