/// \file
/// Whole files as strings of bytes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lcs::sequence {

/// Of a generated sequence. \throws scenario::Error
std::string read_file(const std::filesystem::path& path);

/// Appears whole or not at all; the folders above it are made where they are missing.
/// \throws bench::OutputError
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lcs::sequence
