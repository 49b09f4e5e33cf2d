/// \file
/// The layouts: what a place of a family is built of, where the rover goes, what moves there.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/worlds/movers.h"

namespace lcs::worlds {

/// The fixed parts of a place stand when a layout is returned; `furnish` puts what must not be in
/// the way of rover and movers, once these are known.
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

/// \name What several layouts have.
///@{
/// Up to that many things at drawn places of a rectangle, where there is room.
void scatter(Kit& kit, const std::vector<std::string>& kinds, int count,
             const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, double gap_m = 0.15);
/// Bare, or with a texture.
int wall_surface(Kit& kit);
int floor_surface(Kit& kit, const std::vector<Style>& styles);
/// A grey, or nearly.
int pale(Kit& kit, double low, double high);
/// Four walls round x and y from -half to half, and a ceiling.
void enclose(Kit& kit, const Eigen::Vector2d& half_m, double height_m);
/// Grass, or leaves and stones, that lie about where nothing goes; or none. For `furnish`.
void maybe_strew(Kit& kit, const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m);
/// Shadows on the floor, or none.
void maybe_shadows(Kit& kit, const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m);
///@}

}  // namespace lcs::worlds
