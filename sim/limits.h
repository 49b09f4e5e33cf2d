/// \file
/// What a scene may ask of MuJoCo: sizes that it allocates, indices that it follows and numbers
/// that it divides by without a look at them. Beyond these it crashes, overflows, or takes the
/// machine's memory.
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
