/// \file
/// Scenario files written for a test, in a folder that goes with it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "scenarios/load.h"

namespace lcs::scenario {

/// A folder with a scene in it, and room for scenario files.
class ScenarioFolder {
 public:
  ScenarioFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "lcs-scenarios-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a folder for the test");
    path_ = name;
    write("room.xml", "<mujoco/>");
  }
  ~ScenarioFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScenarioFolder(const ScenarioFolder&) = delete;
  ScenarioFolder& operator=(const ScenarioFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// The smallest scenario there is; tests put lines after it, which begin at line 4.
inline const std::string smallest = "scene: room.xml\nframes: 3\nego: {speed: 0.5}\n";

inline Scenario load_text(const std::string& text, const LoadOptions& options = {}) {
  const ScenarioFolder folder;
  return load(folder.write("test.yaml", text), options);
}

inline std::string without_folder(std::string message, const ScenarioFolder& folder) {
  const std::string prefix = folder.path().string() + "/";
  for (std::size_t at; (at = message.find(prefix)) != std::string::npos;) {
    message.erase(at, prefix.size());
  }
  return message;
}

/// The message that a text is refused with, without the folder's name.
inline std::string refusal(const std::string& text, const LoadOptions& options = {}) {
  const ScenarioFolder folder;
  try {
    load(folder.write("test.yaml", text), options);
  } catch (const Error& error) {
    return without_folder(error.what(), folder);
  }
  return "nothing was refused";
}

}  // namespace lcs::scenario
