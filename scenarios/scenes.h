/// \file
/// Where scenes are found.
#pragma once

#include <filesystem>

#include "scenarios/document.h"

namespace lcs::scenario {

/// The environment's LCS_SCENES, else `scenes/` of the source tree.
std::filesystem::path scenes_folder();

/// A file that ships with the scenes ("ego/wheeled.xml"): the one of `scenes_folder()` if it has
/// one, else that of the source tree, so that a user's folder need not hold them all.
std::filesystem::path shipped_file(const std::filesystem::path& relative);

/// The file of a scene that is given by name, or by a path ending in ".xml".
/// \param folder that such a path starts from.
/// \throws Error saying where it was looked for, and what is there.
std::filesystem::path find_scene(const Value& value, const std::filesystem::path& folder);

}  // namespace lcs::scenario
