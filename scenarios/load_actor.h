/// \file
/// Actors: what they are, how they move, and when they start.
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// Two or more [time, x, y] with times that increase. \throws Error
Waypoints read_waypoints(const Value& value, const std::string& path);

/// \param folder of the scenario file; pictures and shapes of one's own are named relative to it.
/// \throws Error
Actor read_actor(const Entry& entry, const std::filesystem::path& folder);

}  // namespace lcs::scenario
