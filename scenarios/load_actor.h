/// \file
/// Actors: what they are, how they move, and when they start.
#pragma once

#include <filesystem>

#include "scenarios/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// \param folder of the scenario file; pictures are named relative to it.
/// \throws Error
Actor read_actor(const Entry& entry, const std::filesystem::path& folder);

}  // namespace lcs::scenario
