/// \file
/// Operations on edges, shared by the default filter and the paper's filter.
#pragma once

#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/types/layers.h"
#include "filter/types/trust.h"

namespace lcs {

/// Deletes edges with trust below the critical rank, and edges outside of the picture.
void delete_lost(std::vector<Edge>& edges, const Intrinsics& camera, const TrustRanks& trust);

/// Gives an edge the origin, speed and angle of a static point at its place and depth.
void move_as_static(Edge& edge, const Intrinsics& camera, const MotionField& field);

}  // namespace lcs
