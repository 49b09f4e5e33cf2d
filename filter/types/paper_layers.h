/// \file
/// The part of a filter's state that only the paper's filter has, with the paper's symbols.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "filter/kinematics/camera.h"

namespace lcs {

/// Ignorance region psi: corners inside it are skipped in the next frame.
struct IgnoreRegion {
  enum class Shape : std::uint8_t { circle = 1, rectangle = 2 };  ///< Ty
  Shape shape = Shape::circle;
  Vec2 location = Vec2::Zero();  ///< L_psi, px
  Vec2 size = Vec2::Zero();      ///< R_psi, px: radius in x (circle), half sizes (rectangle)
};

/// Collector lambda: a region that groups corners for a trusted circle.
struct Collector {
  Vec2 location = Vec2::Zero();  ///< L_lambda, px
  double radius = 0;             ///< mu_lambda, px
  double depth_ratio = 1;        ///< of its circle: initial value of new edges inside
};

/// A row of alpha: sightings of a corner that may become a rebel edge.
struct Chain {
  std::array<Vec2, 2> sightings;  ///< oldest first, in this frame's pixels (rotation removed)
  int count = 0;                  ///< 1 or 2; the third sighting decides
  double off_field_px = 0;        ///< excess of its steps over the steps of any static point
};

struct PaperLayers {
  std::vector<IgnoreRegion> ignored;  ///< psi that was applied to this frame's corners
  std::vector<Collector> collectors;  ///< lambda that grouped this frame's corners
  std::vector<Chain> chains;          ///< alpha after this frame
};

}  // namespace lcs
