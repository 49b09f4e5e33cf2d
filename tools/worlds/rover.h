/// \file
/// The rover of a world: its camera and sensors, and how it goes along the lane that a layout has
/// left free for it.
#pragma once

#include <vector>

#include "tools/worlds/kit.h"

namespace lcs::worlds {

/// Where the rover may go: from `start_m` on along `heading_rad`, so far and so far to each side.
struct Lane {
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  double length_m = 5;
  double half_width_m = 1;
  double fastest_mps = 1.5;
  double highest_camera_m = 1.6;
  bool is_rough = false;  ///< takes wheels
};

/// Where the rover is at a moment.
struct Stand {
  double t_s = 0;
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
};

/// The rover's way through its lane, as the commands have it.
struct Way {
  std::vector<Stand> frames;  ///< one each
  Box box_of(const scenario::Camera& camera, const Stand& stand) const;
};

/// As the simulator smooths the commands.
Way way_of(const scenario::Scenario& scenario);

/// Draws camera, sensors and commands into the world's scenario.
Way draw_rover(Kit& kit, const Lane& lane);

/// Where a point is seen from a stand: x and y in pixels and its depth in metres, which may be
/// negative.
Eigen::Vector3d seen_at(const scenario::Camera& camera, const Stand& stand, double ground_m,
                        const Eigen::Vector3d& point_m);
Eigen::Vector3d camera_at(const scenario::Camera& camera, const Stand& stand, double ground_m);

}  // namespace lcs::worlds
