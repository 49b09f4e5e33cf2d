/// \file
/// Limits on the numbers of a scene that MuJoCo uses unchecked: sizes that it allocates, indices
/// that it follows, numbers that it divides by. Beyond them it crashes, overflows, or takes all
/// memory.
#pragma once

#include "sim/xml.h"

namespace lcs::sim {

/// \param root of a whole document whose files are absolute paths and exist.
/// \throws scenario::Error at the element that asks for too much, with the limit and its reason.
void check_limits(xml::Element& root);

/// \name Bounds on a scene's size (half of its diagonal), which MuJoCo scales clipping planes by.
///@{
inline constexpr double kLeastExtent_m = 1e-3;
inline constexpr double kMostExtent_m = 1e6;
///@}

}  // namespace lcs::sim
