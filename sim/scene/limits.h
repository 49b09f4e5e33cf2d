/// \file
/// Limits on values of a scene that MuJoCo does not check: divisors, loop counts, indices and
/// sizes. The trial in a child process (sim/base/trial.h) finds the values that crash MuJoCo or
/// take too much memory or time during loading.
#pragma once

#include "sim/scene/mujoco.h"
#include "sim/scene/xml.h"

namespace lcs::sim {

/// \param root of a complete document whose files exist and have absolute paths.
/// \throws input::Error at the element that exceeds a limit, with the limit and its reason.
void check_limits(xml::Element& root);

/// Whether an element has a number that is not finite, beside an open range; or a text that says
/// so.
bool has_endless(const xml::Element& element);

/// Called by the child process, so that the parent never loads a model that fails this check.
/// \throws MujocoError for sizes, indices and numbers that cannot be rendered.
void check_compiled(const mjModel& model);

/// \name Bounds on a scene's extent (half of its diagonal), by which MuJoCo scales clipping planes.
///@{
inline constexpr double kLeastExtent_m = 1e-3;
inline constexpr double kMostExtent_m = 1e6;
///@}

}  // namespace lcs::sim
