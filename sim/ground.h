/// \file
/// Rough ground: a height field over the scene's floor, for wheels to shake on.
///
/// The heights are a sum of plane waves of random direction and phase, and lengths between the
/// scenario's wavelength and three times it: 0 to 4 standard deviations above the floor, 2 in the
/// mean and level with it at the edges. The holonomic rover, which has no contacts, drives through
/// it.
#pragma once

#include <cstdint>
#include <string>

#include "scenarios/scenario.h"
#include "sim/model.h"
#include "sim/xml.h"

namespace lcs::sim {

/// Adds the field, level as yet, to a scene; it looks like the scene's first plane.
/// \param source of the ground's numbers.
void add_ground(xml::Element& scene, const scenario::Ground& ground,
                const Eigen::Vector2d& ego_start_m, const scenario::Source& source);

/// Raises the bumps in a model of that scene.
void raise_ground(Model& model, const scenario::Ground& ground, std::uint64_t scenario_seed);

/// Which of the numbers to change where wheels touch more of the ground at once than MuJoCo has
/// room for: bumps that are short and high beside a wheel.
std::string less_contact(const scenario::Ground& ground);

}  // namespace lcs::sim
