/// \file
/// Reading files of a generated sequence.
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/input_file.h"

namespace lcs::sequence {

/// The bytes of a file. \throws scenario::Error
inline std::string read_file(const std::filesystem::path& path) {
  // the longest is a table of all frames
  constexpr scenario::FileKind kSequenceFile{16 * scenario::kGibibyte,
                                             "generate the sequence again"};
  return scenario::read_file(path, kSequenceFile);
}

}  // namespace lcs::sequence
