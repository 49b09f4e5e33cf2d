/// \file
/// Whole files as strings of bytes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lcs::sequence {

/// The bytes of a file of a generated sequence. \throws scenario::Error
std::string read_file(const std::filesystem::path& path);

/// Writes a file that appears whole or not at all, and makes folders above it that are missing.
/// \throws bench::OutputError
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lcs::sequence
