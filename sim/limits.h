/// \file
/// Limits on a scene that MuJoCo 2.2.2 does not check: numbers that it divides by or loops over,
/// indices that it follows, sizes that it draws. What makes MuJoCo crash, or take too much memory
/// or time while it loads, is left to the trial in a child process (sim/trial.h).
#pragma once

#include "sim/mujoco.h"
#include "sim/xml.h"

namespace lcs::sim {

/// \param root of a whole document whose files are absolute paths and exist.
/// \throws scenario::Error at the element beyond a limit, with the limit and its reason.
void check_limits(xml::Element& root);

/// For the child process: what is wrong in the compiled model must not be loaded by its parent.
/// \throws MujocoError for sizes, indices and numbers that cannot be drawn.
void check_compiled(const mjModel& model);

/// \name Bounds on a scene's size (half of its diagonal), which MuJoCo scales clipping planes by.
///@{
inline constexpr double kLeastExtent_m = 1e-3;
inline constexpr double kMostExtent_m = 1e6;
///@}

}  // namespace lcs::sim
