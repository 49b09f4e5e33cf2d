/// \file
/// Scenario files for a test, in a folder that is deleted afterwards.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scenarios/load.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::scenario {

/// A folder with a scene, in which tests write scenario files.
class ScenarioFolder : public test::TemporaryFolder {
 public:
  ScenarioFolder() { write("room.xml", "<mujoco/>"); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path() / name, std::ios::binary) << bytes;
    return path() / name;
  }
};

/// The smallest scenario; tests append lines, which begin at line 4.
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

/// The error message for a text, without the folder's name.
inline std::string refusal(const std::string& text, const LoadOptions& options = {}) {
  const ScenarioFolder folder;
  const auto file = folder.write("test.yaml", text);
  return without_folder(test::refusal_of<input::Error>([&] { load(file, options); }), folder);
}

}  // namespace lcs::scenario
