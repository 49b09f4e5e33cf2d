/// \file
/// Sequences while `lcs generate` makes them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "tests/tools/files.h"

namespace lcs::test {

/// Whether some process has finished a frame: its journal has a row behind the three lines of the
/// head. \param unfinished the folder FOLDER.unfinished.
inline bool has_frame(const std::filesystem::path& unfinished) {
  std::error_code error;  // while there is no such folder
  for (const auto& entry : std::filesystem::directory_iterator(unfinished / "work", error)) {
    if (entry.path().filename().string().starts_with("frames-") &&
        std::ranges::count(read(entry.path()), '\n') > 3) {
      return true;
    }
  }
  return false;
}

}  // namespace lcs::test
