/// \file
/// Rough ground: a height field over the scene's floor that shakes a wheeled rover.
///
/// The heights are a sum of plane waves with random directions and phases, and lengths of one to
/// three times the scenario's wavelength. They lie 0 to 4 standard deviations above the floor, 2 on
/// average, and fall to the floor at the edges. The holonomic rover has no contacts and drives
/// through it.
#pragma once

#include <cstdint>

#include "scenarios/scenario.h"
#include "sim/scene/model.h"

namespace lcs::sim {

/// Height of the highest bumps, in standard deviations.
inline constexpr double kHighestGround = 4;

/// Adds the height field, still flat, with the material of the scene's first plane, and with none
/// of the scene's defaults. \param group of MuJoCo's, which is drawn.
void add_ground(mjSpec& scene, const scenario::RoughGround& ground,
                const Eigen::Vector2d& ego_start_m, int group);

/// Writes the heights into a model of that scene.
void raise_ground(Model& model, const scenario::RoughGround& ground, std::uint64_t scenario_seed);

}  // namespace lcs::sim
