/// \file
/// The mean circle C_m of a group of edges.
#pragma once

#include <span>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/types/layers.h"

namespace lcs {

/// Mean place and motion of the edges; the radius reaches the outermost edge.
/// \param group indices into `edges`; at least one, all of one kind.
/// \param same gives id, trust and age.
Circle mean_circle(const std::vector<Edge>& edges, std::span<const int> group,
                   const MotionField& field, const Circle& same = {});

}  // namespace lcs
