/// \file
/// Checks that a rover's or actor's file has all required elements; `scenes/README.md` lists them.
#pragma once

#include "sim/scene/fragment.h"

namespace lcs::sim {

/// All throw input::Error at the file's line: the missing or wrong element, and the remedy.
///@{
/// \return the body `base`.
mjsBody& check_base(const mjSpec& spec, const SpecReader& reader,
                    const std::filesystem::path& file);
/// \return the size that the file states.
Eigen::Vector3d check_actor(const Fragment& actor, const SpecReader& reader);
/// \param base whose joints are at zero: the bodies in it are those that `Gait` moves.
void check_walker(const mjsBody& base, const SpecReader& reader);
void check_rover(const Fragment& rover, const SpecReader& reader);
///@}

/// Whether a rover that passed `check_rover` is wheeled; otherwise it is holonomic.
bool is_wheeled(const mjSpec& spec);

}  // namespace lcs::sim
