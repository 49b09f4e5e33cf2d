/// \file
/// What moves in a world: paths that are free, and seen.
#pragma once

#include <string>
#include <vector>

#include "tools/worlds/rover.h"
#include "tools/worlds/things.h"

namespace lcs::worlds {

/// What a layout lets move, and where.
struct Traffic {
  std::vector<std::string> kinds;               ///< of things (things.h)
  Eigen::Vector2d low_m{-5, -5}, high_m{5, 5};  ///< corners of the ground that is theirs
  double fastest_mps = 2;
  double farthest_m = 8;  ///< from the camera, in the middle of its way
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

/// Draws movers one by one, each free of what stands already, of the rover and of each other.
/// \return fewer than were asked for where no free path was found.
std::vector<Mover> draw_movers(Kit& kit, const Way& way, const Traffic& traffic, int count);

/// Frames of the run in which a mover moves and can be seen, by the plan.
int frames_seen(const Kit& kit, const Way& way, const std::vector<Mover>& movers,
                std::size_t which);

/// Puts them into the scene and the scenario, and tells what they show.
void add_movers(Kit& kit, const Way& way, const std::vector<Mover>& movers);

}  // namespace lcs::worlds
