/// \file
/// The mean circle C_m of a group of edges.
#pragma once

#include <span>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"

namespace lcs {

/// Where its edges are in the mean, and how they move; it reaches as far as they do. Without id,
/// trust and age.
/// \param group indices of edges, of which there must be some, of one kind.
Circle mean_circle(const std::vector<Edge>& edges, std::span<const int> group,
                   const MotionField& field);

}  // namespace lcs
