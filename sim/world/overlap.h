/// \file
/// Penetration depth of two geoms of a model, with or without contacts.
#pragma once

#include <Eigen/Core>
#include <map>

#include "sim/scene/model.h"

namespace lcs::sim {

class Overlap {
 public:
  /// An overlap at the last forward pass.
  struct Place {
    double depth_m = 0;  ///< least translation that separates the two geoms; 0 if they are apart
    Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< a point in both geoms, in W
  };

  /// The overlap of two geoms; neither may be a plane or a height field. A mesh is its surface and
  /// the enclosed volume, not its hull: the space under a table is free. Depths of round geoms and
  /// meshes may be too large by a few per cent, never too small. Separate geoms have depth 0.
  /// \param least_depth_m smaller depths count as separate.
  Place of(const Model& model, int geom_a, int geom_b, double least_depth_m);

  /// The overlap of a geom with a bounded plane: the geom extends that deep to both of its sides.
  Place across(const Model& model, int plane, int geom, double least_depth_m);

  /// Points whose convex hull is the geom, in the geom's frame; computed once.
  const Eigen::Matrix3Xd& hull(const Model& model, int geom);

 private:
  double width_m(const Model& model, int geom_a, int geom_b, const Eigen::Vector3d& direction_W);

  std::map<int, Eigen::Matrix3Xd> hulls_;
};

}  // namespace lcs::sim
