#include "scenarios/shipped.h"

#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "scenarios/input/spelling.h"

namespace lcs::scenario {

namespace fs = std::filesystem;

namespace {

fs::path& program_file() {
  static fs::path file = "/proc/self/exe";  // also after a rebuild
  return file;
}

}  // namespace

const fs::path& program() {
  return program_file();
}

void set_program(fs::path file) {
  program_file() = std::move(file);
}

fs::path shipped_folder(const fs::path& name) {
  std::error_code error;
  const fs::path file = fs::canonical(program(), error);
  const fs::path installed = (file.parent_path() / LCS_DATA / name).lexically_normal();
  if (!error && fs::is_directory(installed, error)) return installed;
  return fs::path(LCS_SOURCES) / name;
}

std::optional<fs::path> shipped_scenario(const fs::path& name) {
  if (name.has_extension() || name.has_parent_path() || name.empty()) return std::nullopt;
  fs::path file = name;
  file += ".yaml";
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(shipped_folder("scenarios"))) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
    if (entry.path().filename() != file) continue;
    for (const fs::path& here : {name, file}) {
      if (!fs::exists(here) || fs::equivalent(here, entry.path())) continue;
      throw std::runtime_error("'" + name.string() + "' is a scenario of the project, and " +
                               here.string() + " is here too; give ./" + here.string() + " or " +
                               entry.path().string());
    }
    return entry.path();
  }
  if (const auto near = fs::exists(name) ? std::nullopt : input::nearest(name.string(), names)) {
    throw std::runtime_error("'" + name.string() + "' is no scenario and no file; did you mean '" +
                             *near + "'?");
  }
  return std::nullopt;
}

}  // namespace lcs::scenario
