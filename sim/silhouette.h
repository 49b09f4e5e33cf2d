/// \file
/// How many pixels a body would cover if nothing hid it and the image had no border.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/mujoco.h"
#include "sim/pose.h"

namespace lcs::sim {

/// A body as a union of convex parts, each given by points whose hull it is, in the body's frame.
/// Round parts are circumscribed to better than 0.5 % of their outline.
using ConvexParts = std::vector<Eigen::Matrix3Xd>;

/// Points whose hull is a geom, in the geom's frame. \throws MujocoError for a geom without bounds
/// (a plane) or without a convex outline (a height field).
Eigen::Matrix3Xd geom_hull(const mjModel& m, int geom);

/// Pixels of the full silhouette, parts outside the image included, by the rule of the renderer: a
/// pixel counts if its centre is covered. 0 for a body that reaches behind the plane `near_m`
/// before the camera: its silhouette has no bounds there.
double silhouette_px(const Pinhole& camera, const Pose& T_CO, const ConvexParts& parts,
                     double near_m);

}  // namespace lcs::sim
