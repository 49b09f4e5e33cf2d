/// \file
/// The movers of a world, on free and visible paths.
#pragma once

#include <string>
#include <vector>

#include "tools/worlds/rover.h"
#include "tools/worlds/things.h"

namespace lcs::worlds {

/// The movers of a layout, and their area.
struct Traffic {
  std::vector<std::string> kinds;               ///< of things (things.h)
  Eigen::Vector2d low_m{-5, -5}, high_m{5, 5};  ///< corners of their area
  double fastest_mps = 2;
  double farthest_m = 8;  ///< from the camera, halfway along its path
  int most = 4;
};

struct Mover {
  std::string name;
  Parts parts;
  scenario::Trajectory trajectory;
  double start_s = 0;
  double heading_rad = 0;  ///< at rest, before it starts

  Box box_at(const Kit& kit, double t_s) const;
};

/// Draws movers one by one, each clear of static things, of the rover and of other movers.
/// \return fewer than `count` if no free path was found.
std::vector<Mover> draw_movers(Kit& kit, const Way& way, const Traffic& traffic, int count);

/// Number of the run's frames in which a mover moves and is visible, by the plan.
int frames_seen(const Kit& kit, const Way& way, const std::vector<Mover>& movers,
                std::size_t which);

/// Adds the movers to scene and scenario, and tags the world's features that they show.
void add_movers(Kit& kit, const Way& way, const std::vector<Mover>& movers);

}  // namespace lcs::worlds
