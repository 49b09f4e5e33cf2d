/// \file
/// Surfaces of different geoms in one place: a picture shows now one and now the other, so that
/// labels and textures change from frame to frame.
#pragma once

#include <utility>
#include <vector>

#include "sim/scene/model.h"

namespace lcs::sim {

/// The pairs of geoms of which a part of the surfaces, as faces of a wall and of a door in it, is
/// in one place, to 0.1 mm, as a camera at `eye` sees. It is found by rays onto the six sides of
/// each geom; a common part below a quarter of a side of both is passed over.
/// \param is_drawn of each geom; others have no surface.
std::vector<std::pair<int, int>> coplanar_geoms(const Model& model,
                                                const std::vector<char>& is_drawn,
                                                const Eigen::Vector3d& eye);

}  // namespace lcs::sim
