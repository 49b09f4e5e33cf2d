/// \file
/// Finds scenes, rovers and actors. A name means a file that ships with the project; a path means a
/// user's file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/input/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// The folder in the environment variable LCS_SCENES, or else the folder of the shipped scenes.
std::filesystem::path scenes_folder();

/// \name The file of a rover or an actor: the scenario's own file, if given. Else a file such as
/// "ego/wheeled.xml" in `scenes_folder()`, or, if absent there, in the shipped folder. So a user's
/// folder need not have all files.
///@{
std::filesystem::path rover_file(const Ego& ego);
std::filesystem::path actor_file(const Actor& actor);  ///< for an actor with a shape
///@}

/// One line per name in the scenario that exists both in LCS_SCENES and in the shipped folder; says
/// which file is used.
std::vector<std::string> shadowed_files(const Scenario& scenario);

/// The file of a scene, given by name or by a path that ends in ".xml".
/// \param folder base of a relative path.
/// \throws Error with the searched folders and the scenes there.
std::filesystem::path find_scene(const input::Value& value, const std::filesystem::path& folder);

/// The file that a value names. \param folder base of a relative path.
/// \param missing start of the message, for example "there is no picture ".
/// \throws Error if there is no such file.
std::filesystem::path file_beside(const input::Value& value, const std::filesystem::path& folder,
                                  const std::string& missing);

/// The remedy in a message about a missing file. \param folder base of a relative path.
std::string path_remedy(const std::filesystem::path& folder);

}  // namespace lcs::scenario
