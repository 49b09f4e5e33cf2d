/// \file
/// Files for tests, and the files that a command left.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

namespace lcs::test {

/// A file's bytes; the test fails if the file does not exist.
inline std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Writes a file, creating its folders if necessary.
inline void write(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Names of a folder's entries, without the records of written files (tools/files/written.h).
inline std::set<std::string> entries(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.path().string().ends_with(".lcs-written")) names.insert(entry.path().filename());
  }
  return names;
}

/// Bytes of all files in a folder, recursively, by relative path.
inline std::map<std::string, std::string> bytes_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> bytes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    bytes[entry.path().lexically_relative(folder).string()] = read(entry.path());
  }
  return bytes;
}

}  // namespace lcs::test
