#include "scenarios/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <span>
#include <stdexcept>
#include <system_error>

#include "scenarios/input/reader.h"
#include "scenarios/shipped.h"

namespace lcs::scenario {

namespace {

/// " (it has lab, street)", or empty.
std::string scenes_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder, error)) {
    if (file.path().extension() == ".xml") names.push_back(file.path().stem().string());
  }
  std::ranges::sort(names);
  return names.empty() ? "" : fmt::format(" (it has {})", fmt::join(names, ", "));
}

/// \param kind an enumerator, by whose number `files` are in order. \throws std::invalid_argument
/// if it has no file.
const char* file_of(auto kind, std::span<const char* const> files) {
  const auto place = static_cast<std::size_t>(kind);
  if (place >= files.size()) throw std::invalid_argument("this does not ship with the project");
  return files[place];
}

const char* name_of(const Ego& ego) {
  constexpr std::array kFiles{"ego/holonomic.xml", "ego/wheeled.xml"};
  return ego.is_carried() ? "ego/carried.xml" : file_of(ego.drive, kFiles);
}

const char* name_of(Shape shape) {
  constexpr std::array kFiles{"actors/box.xml", "actors/cylinder.xml", "actors/pedestrian.xml",
                              "actors/car.xml", "actors/walker.xml"};
  return file_of(shape, kFiles);
}

const fs::path& shipped_scenes() {
  static const fs::path folder = shipped_folder("scenes");
  return folder;
}

fs::path shipped_file(const fs::path& name) {
  const fs::path file = scenes_folder() / name;
  return fs::exists(file) ? file : shipped_scenes() / name;
}

}  // namespace

fs::path scenes_folder() {
  const char* const folder = std::getenv("LCS_SCENES");
  return folder && *folder ? fs::path(folder) : shipped_scenes();
}

fs::path rover_file(const Ego& ego) {
  return ego.drive == Drive::own ? ego.drive_file : shipped_file(name_of(ego));
}

fs::path actor_file(const Actor& actor) {
  return actor.shape == Shape::own ? actor.shape_file : shipped_file(name_of(actor.shape));
}

std::vector<std::string> shadowed_files(const Scenario& scenario) {
  if (scenario.recording) return {};
  std::set<fs::path> names;
  const fs::path scene = scenario.scene.filename();
  if (scenario.scene == scenes_folder() / scene) names.insert(scene);
  if (scenario.ego.drive != Drive::own) names.insert(name_of(scenario.ego));
  for (const Actor& actor : scenario.actors) {
    if (!actor.body && actor.shape != Shape::own) names.insert(name_of(actor.shape));
  }
  std::vector<std::string> lines;
  std::error_code none;  // a missing file is no other file
  for (const fs::path& name : names) {
    const fs::path used = scenes_folder() / name, other = shipped_scenes() / name;
    if (!fs::exists(used, none) || !fs::exists(other, none)) continue;
    if (fs::equivalent(used, other, none)) continue;
    lines.push_back(used.string() + " is used, as LCS_SCENES says, and not the project's own " +
                    other.string() + "; unset LCS_SCENES for that one, or rename the file");
  }
  return lines;
}

fs::path find_scene(const input::Value& value, const fs::path& folder) {
  const std::string& text = input::as_text(value, "scene");
  if (text.ends_with(".xml")) return file_beside(value, folder, "there is no scene file ");
  std::error_code too_long;  // for a name that no file can have
  const fs::path scenes = scenes_folder();
  const fs::path file = scenes / (text + ".xml");
  if (fs::is_regular_file(file, too_long)) return file;
  throw input::Error(value.where, "there is no scene '" + text + "' at " + file.string() +
                                      "; give the name of a scene in that folder" +
                                      scenes_in(scenes) + " or a path that ends in .xml");
}

fs::path file_beside(const input::Value& value, const fs::path& folder,
                     const std::string& missing) {
  const fs::path file = folder / value.text;
  std::error_code too_long;  // for a name that no file can have
  if (fs::is_regular_file(file, too_long)) return file;
  throw input::Error(value.where, missing + file.string() + "; " + path_remedy(folder));
}

std::string path_remedy(const fs::path& folder) {
  return folder.empty() ? "give its path from the current folder"
                        : "give its path relative to the scenario file";
}

}  // namespace lcs::scenario
