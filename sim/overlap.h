/// \file
/// How deep two geoms of a model overlap, whether or not they have contacts.
#pragma once

#include <Eigen/Core>
#include <map>

#include "sim/model.h"

namespace lcs::sim {

class Overlap {
 public:
  /// As things stood at the last forward pass.
  struct Place {
    double depth_m = 0;  ///< how far one would have to move to be free of the other; 0: apart
    Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< of W, in both
  };

  /// Where two geoms overlap, neither of which may be a plane or a height field. A mesh is its
  /// surface and what that encloses, not its hull, so that things may stand under a table or in a
  /// room. Depths of round geoms and of meshes may be too large by some per cent, never too small;
  /// geoms that are apart have none.
  /// \param least_depth_m smaller depths count as apart.
  Place of(const Model& model, int geom_a, int geom_b, double least_depth_m);

  /// Whether a geom crosses a plane within its borders, at least so deep on either side.
  Place across(const Model& model, int plane, int geom, double least_depth_m);

  /// Points whose hull is the geom, in the geom's frame; computed once.
  const Eigen::Matrix3Xd& hull(const Model& model, int geom);

 private:
  double width_m(const Model& model, int geom_a, int geom_b, const Eigen::Vector3d& direction_W);

  std::map<int, Eigen::Matrix3Xd> hulls_;
};

}  // namespace lcs::sim
