/// \file
/// The filter's state at the end of a frame: edges, circles and squares, with the paper's symbols.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "filter/kinematics/camera.h"

namespace lcs {

/// Identifies a landmark or layer for its whole life; unique within a run and kind. 32 bits would
/// overflow within a week of a busy street.
using Id = std::uint64_t;

/// A tracked corner: E_n moves as a static point, E_r (rebel) does not.
struct Edge {
  Id id = 0;
  bool rebel = false;
  Vec2 location = Vec2::Zero();   ///< L, px
  Vec2 origin = Vec2::Zero();     ///< O, px: first sighting (rebel), FOE (normal)
  Vec2 rotated = Vec2::Zero();    ///< L of the last frame, rotated to this one, px
  Vec2 predicted = Vec2::Zero();  ///< L~, px: predicted place in this frame
  double speed = 0;               ///< V, px/s, along beta; never negative
  double depth_ratio = 1;         ///< V / V_v = Z_ref / Z, equal for landmarks of one depth
  double angle = 0;               ///< beta, of the direction of motion seen from O
  double mu = 0;                  ///< normal: radius of detection, px; rebel: deviation angle, rad
  int trust = 0;                  ///< Tr
  int age = 0;                    ///< frames since its creation
  /// Standard deviation of depth_ratio; infinite if unknown.
  double depth_ratio_sigma = std::numeric_limits<double>::infinity();
  int corner = -1;  ///< index of its corner in this frame, -1: none
  int circle = -1;  ///< index in its kind's circles, -1: none

  /// px/s, rotation removed.
  Vec2 velocity() const { return speed * Vec2(std::cos(angle), std::sin(angle)); }
};

/// A group of edges with similar motion: C_n or C_r.
struct Circle {
  Id id = 0;
  bool rebel = false;
  Vec2 location = Vec2::Zero();  ///< L, px
  Vec2 origin = Vec2::Zero();    ///< O, px
  double radius = 0;             ///< R, px
  double speed = 0;              ///< V, px/s
  double depth_ratio = 1;        ///< V / V_v
  double angle = 0;              ///< beta
  int trust = 0;                 ///< Tr
  int age = 0;
  int members = 0;        ///< number of its edges in this frame; 0 while it coasts
  bool ignoring = false;  ///< the paper's filter: makes a region of psi in the next frame
};

/// A convex polygon of at most `kMost` vertices, stored in place to avoid allocation.
struct Outline {
  static constexpr int kMost = 32;

  Outline() { places.fill(Vec2::Zero()); }
  std::span<Vec2> vertices() { return {places.data(), static_cast<std::size_t>(count)}; }
  std::span<const Vec2> vertices() const {
    return {places.data(), static_cast<std::size_t>(count)};
  }

  /// px: clockwise in the picture, from the leftmost vertex; no three are collinear.
  std::array<Vec2, kMost> places;
  int count = 0;  ///< number of vertices, first in `places`
};

/// An object (or a layer of objects at one depth): S, an axis-aligned rectangle.
struct Square {
  Id id = 0;
  Vec2 location = Vec2::Zero();   ///< L, px, its centre
  Vec2 half_size = Vec2::Zero();  ///< R, px
  Vec2 origin = Vec2::Zero();     ///< O, px
  double speed = 0;               ///< V, px/s
  double depth_ratio = 1;         ///< V / V_v
  double angle = 0;               ///< beta
  int trust = 0;                  ///< Tr
  int age = 0;
  int circles = 0;        ///< number of its circles in this frame; 0 while it coasts
  int rebel_circles = 0;  ///< number of rebel ones among them
  bool ignoring = false;  ///< the paper's filter: makes a region of psi in the next frame
  /// The convex hull of its edges; the square is its box. Empty in the paper's filter.
  Outline outline;
};

/// Values for normal and rebel edges or circles.
template <typename T>
struct BothKinds {
  std::vector<T> normal, rebel;
};

struct Layers {
  std::vector<Edge> normal_edges;      ///< E_n
  std::vector<Edge> rebel_edges;       ///< E_r
  std::vector<Circle> normal_circles;  ///< C_n
  std::vector<Circle> rebel_circles;   ///< C_r
  std::vector<Square> squares;         ///< S

  /// |E_n| + |E_r| + |C_n| + |C_r| + |S|, the paper's dimensionality.
  std::size_t dimension() const {
    return normal_edges.size() + rebel_edges.size() + normal_circles.size() + rebel_circles.size() +
           squares.size();
  }
};

/// Classification of a corner.
enum class Verdict : std::uint8_t {
  ignored,  ///< inside psi
  pending,  ///< new, or a candidate in alpha
  normal,   ///< supports a normal edge
  rebel,    ///< supports a rebel edge
};

}  // namespace lcs
