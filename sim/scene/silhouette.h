/// \file
/// Number of pixels that a body would cover without occlusion and image border.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/pose.h"
#include "sim/scene/mujoco.h"

namespace lcs::sim {

/// A body as a union of convex parts, each the hull of its points, in the body's frame. Round parts
/// are polyhedra whose outline is within 0.5 % of the true one.
using ConvexParts = std::vector<Eigen::Matrix3Xd>;

/// Points whose convex hull is the geom, in the geom's frame. \throws MujocoError for an unbounded
/// geom (plane) or a non-convex one (height field).
Eigen::Matrix3Xd geom_hull(const mjModel& m, int geom);

/// Pixels of the full silhouette, including parts outside the image. As in the renderer, a pixel
/// counts if its centre is covered. 0 for a body that reaches behind the plane z = `near_m` of the
/// camera: its silhouette is unbounded there.
double silhouette_px(const Pinhole& camera, const Pose& T_CO, const ConvexParts& parts,
                     double near_m);

}  // namespace lcs::sim
