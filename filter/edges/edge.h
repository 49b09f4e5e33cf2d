/// \file
/// Operations on edges that the default filter and the paper's share.
#pragma once

#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/trust.h"

namespace lcs {

/// Deletes the edges whose trust is below its critical rank, and those outside of the picture.
void delete_lost(std::vector<Edge>& edges, const Intrinsics& camera, const TrustRanks& trust);

/// Sets the origin, speed and angle of an edge to those of a static point of its depth and place.
void move_as_static(Edge& edge, const Intrinsics& camera, const MotionField& field);

}  // namespace lcs
