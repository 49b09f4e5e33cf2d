/// \file
/// Where scenes, rovers and actors are found: those that ship with the project, by their names, and
/// one's own, by the paths of their files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/reader.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// The environment's LCS_SCENES, else the folder of those that ship.
std::filesystem::path scenes_folder();

/// Says where those that ship are, in place of `shipped_folder`: for a module of another program.
/// To be called before anything else here.
void set_shipped_scenes(std::filesystem::path folder);

/// \name Of one's own, or the one that ships with the project ("ego/wheeled.xml"): that of
/// `scenes_folder()` if it has one, else that of those that ship, so that a user's folder need not
/// hold them all.
///@{
std::filesystem::path rover_file(const Ego& ego);
std::filesystem::path actor_file(const Actor& actor);  ///< of an actor with a shape
///@}

/// Which file is used where both the environment's LCS_SCENES and those that ship have one of a
/// name that the scenario uses: a line for people each.
std::vector<std::string> shadowed_files(const Scenario& scenario);

/// The file of a scene that is given by name, or by a path ending in ".xml".
/// \param folder that such a path starts from.
/// \throws Error saying where it was looked for, and what is there.
std::filesystem::path find_scene(const Value& value, const std::filesystem::path& folder);

/// The file that a value names. \param folder that its path starts from.
/// \param missing what a message says before the path, as "there is no picture ".
/// \throws Error where there is no such file.
std::filesystem::path file_beside(const Value& value, const std::filesystem::path& folder,
                                  const std::string& missing);

/// What to do about a file that is not there. \param folder that its path starts from.
std::string path_remedy(const std::filesystem::path& folder);

/// What else than a word may be given for a rover's drive and an actor's shape.
inline constexpr const char* kOwnFile = "the path of an .xml file";

/// The file under a key whose value ends in ".xml"; none for any other value.
/// \throws Error as `file_beside`.
std::optional<std::filesystem::path> own_file(Reader& reader, const char* key,
                                              const std::filesystem::path& folder);

}  // namespace lcs::scenario
