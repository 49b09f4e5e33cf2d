/// \file
/// Folders for a test's files: no two processes share one.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace lcs::test {

/// A folder that is deleted with this object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "lcs-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A folder of this process alone, deleted at its end. Tests that run side by side and have one
/// name in two suites would overwrite each other's files in a common folder.
inline const std::filesystem::path& folder_of_the_process() {
  static const TemporaryFolder folder;
  return folder.path();
}

}  // namespace lcs::test
