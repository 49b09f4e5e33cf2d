/// \file
/// SHA-256 by OpenSSL, for manifests.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lcs::sequence {

/// 64 lower-case hexadecimal digits. \throws std::runtime_error if OpenSSL fails.
std::string sha256(std::string_view bytes);

/// The SHA-256 of a file's bytes. \throws std::runtime_error if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace lcs::sequence
