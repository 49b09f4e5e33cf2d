#include "scenarios/scenes.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

#include "scenarios/reader.h"

namespace lcs::scenario {
namespace {

/// " (it has lab, street)", or nothing.
std::string scenes_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(folder, error)) {
    if (file.path().extension() == ".xml") names.push_back(file.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? " (it has " : ", ") + name;
  return text.empty() ? text : text + ")";
}

}  // namespace

std::filesystem::path scenes_folder() {
  const char* const folder = std::getenv("LCS_SCENES");
  return folder && *folder ? folder : LCS_SCENES_DIR;
}

std::filesystem::path shipped_file(const std::filesystem::path& relative) {
  const std::filesystem::path file = scenes_folder() / relative;
  return std::filesystem::exists(file) ? file : LCS_SCENES_DIR / relative;
}

std::filesystem::path find_scene(const Value& value, const std::filesystem::path& folder) {
  const std::string& text = as_text(value, "scene");
  std::error_code too_long;  // a name that no file can have
  if (text.ends_with(".xml")) {
    const std::filesystem::path file = folder / text;
    if (std::filesystem::is_regular_file(file, too_long)) return file;
    throw Error(value.where, "there is no scene file " + file.string() +
                                 "; give its path relative to the scenario file");
  }
  const std::filesystem::path scenes = scenes_folder();
  const std::filesystem::path file = scenes / (text + ".xml");
  if (std::filesystem::is_regular_file(file, too_long)) return file;
  throw Error(value.where, "there is no scene '" + text + "' at " + file.string() +
                               "; give the name of a scene in that folder" + scenes_in(scenes) +
                               " or a path that ends in .xml");
}

}  // namespace lcs::scenario
