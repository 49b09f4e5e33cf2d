/// \file
/// The rover: what it is, where it starts, and how it moves.
#pragma once

#include <filesystem>

#include "scenarios/reader.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// \param folder of the scenario file; a rover of one's own is named relative to it.
/// \throws Error
Ego read_ego(Reader reader, const std::filesystem::path& folder);

}  // namespace lcs::scenario
