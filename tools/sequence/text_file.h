/// \file
/// Reading files of a generated sequence.
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/input/input_file.h"

namespace lcs::sequence {

/// The bytes of a file. \throws input::Error
inline std::string read_file(const std::filesystem::path& path) {
  // the longest is a table of all frames
  constexpr input::FileKind kSequenceFile{16 * input::kGibibyte, "generate the sequence again"};
  return input::read_file(path, kSequenceFile);
}

}  // namespace lcs::sequence
