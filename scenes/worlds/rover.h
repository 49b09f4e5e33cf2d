/// \file
/// The rover of a world: its camera, its sensors, and its path along the layout's free lane.
#pragma once

#include <vector>

#include "scenes/worlds/kit.h"

namespace lcs::worlds {

/// The rover's free lane: from `start_m` along x, with length and half width.
struct Lane {
  Vector2d start_m = Vector2d::Zero();
  double length_m = 5;
  double half_width_m = 1;
  double fastest_mps = 1.5;
  double highest_camera_m = 1.6;
  bool is_rough = false;  ///< has wheel contact
};

/// The rover's pose at a time.
struct Stand {
  double t_s = 0;
  Vector2d at_m = Vector2d::Zero();
  double heading_rad = 0;
};

/// The rover's path through its lane, from the commands.
struct RoverPath {
  std::vector<Stand> frames;  ///< one for each frame
  TurnedBox box_of(const scenario::Camera& camera, const Stand& stand) const;
};

/// The path of the commands, with the simulator's smoothing.
RoverPath way_of(const scenario::Scenario& scenario);

/// Draws camera, sensors and commands of the world's scenario.
RoverPath draw_rover(Kit& kit, const Lane& lane);

/// Projects a point into the camera at a stand: x and y in pixels and its depth in metres, which
/// may be negative.
Vector3d seen_at(const scenario::Camera& camera, const Stand& stand, double ground_m,
                 const Vector3d& point_m);
Vector3d camera_at(const scenario::Camera& camera, const Stand& stand, double ground_m);

}  // namespace lcs::worlds
