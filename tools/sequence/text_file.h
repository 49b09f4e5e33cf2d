/// \file
/// Whole files as strings of bytes.
#pragma once

#include <filesystem>
#include <string>

namespace lcs::sequence {

/// The bytes of a file of a generated sequence. \throws scenario::Error
std::string read_file(const std::filesystem::path& path);

}  // namespace lcs::sequence
