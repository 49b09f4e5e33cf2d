/// \file
/// Finds scenes, rovers and actors. A name stands for one that ships with the project, a path for a
/// file of one's own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// The folder in the environment's LCS_SCENES, or else that of the scenes that ship.
std::filesystem::path scenes_folder();

/// Sets the folder of the scenes that ship with the project, where `shipped_folder` cannot find it:
/// in a module that another program loads. Call it before all other functions here.
void set_shipped_scenes(std::filesystem::path folder);

/// \name The file of a rover or an actor: the scenario's own, if it names one. Else a file such as
/// "ego/wheeled.xml" is looked for in `scenes_folder()` first and then in the folder that ships, so
/// that a user's folder need not hold all of them.
///@{
std::filesystem::path rover_file(const Ego& ego);
std::filesystem::path actor_file(const Actor& actor);  ///< of an actor with a shape
///@}

/// A line for people for each name in the scenario that both LCS_SCENES and the folder that ships
/// have a file of, saying which one is used.
std::vector<std::string> shadowed_files(const Scenario& scenario);

/// The file of a scene that is given by name, or by a path that ends in ".xml".
/// \param folder a relative path starts there.
/// \throws Error that says where the scene was looked for and which scenes are there.
std::filesystem::path find_scene(const Value& value, const std::filesystem::path& folder);

/// The file that a value names. \param folder a relative path starts there.
/// \param missing begins the message, as "there is no picture ".
/// \throws Error where there is no such file.
std::filesystem::path file_beside(const Value& value, const std::filesystem::path& folder,
                                  const std::string& missing);

/// What a message advises about a missing file. \param folder a relative path starts there.
std::string path_remedy(const std::filesystem::path& folder);

}  // namespace lcs::scenario
