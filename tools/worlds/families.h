/// \file
/// Layouts of the families: the parts of a place, the rover's lane, and the traffic.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/worlds/movers.h"

namespace lcs::worlds {

/// A returned layout already has its fixed parts; `furnish` adds those that must not block rover
/// and movers, once their paths are known.
struct Layout {
  Lane lane;
  Traffic traffic;
  std::function<void()> furnish;
};

Layout lay_out_room(Kit& kit);
Layout lay_out_corridor(Kit& kit);
Layout lay_out_warehouse(Kit& kit);
Layout lay_out_street(Kit& kit);
Layout lay_out_yard(Kit& kit);
Layout lay_out_garage(Kit& kit);

/// \name Shared by several layouts.
///@{
/// Places up to `count` things at random free positions of a rectangle.
void scatter(Kit& kit, const std::vector<std::string>& kinds, int count,
             const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, double gap_m = 0.15);
/// A plain colour or a texture.
int wall_surface(Kit& kit);
int floor_surface(Kit& kit, const std::vector<Style>& styles);
/// A grey, possibly with a slight tint.
int pale(Kit& kit, double low, double high);
/// Four walls at x and y of +-half, and a ceiling.
void enclose(Kit& kit, const Eigen::Vector2d& half_m, double height_m);
/// Randomly adds grass, or leaves and stones, off the paths. Call it in `furnish`.
void maybe_strew(Kit& kit, const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m);
/// Randomly adds shadows on the floor.
void maybe_shadows(Kit& kit, const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m);
///@}

}  // namespace lcs::worlds
