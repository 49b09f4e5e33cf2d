/// \file
/// SHA-256 by OpenSSL.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace lcs::bench {

/// 64 lower-case hexadecimal digits. \throws std::runtime_error if OpenSSL fails.
std::string sha256(std::string_view bytes);

/// The SHA-256 of a regular file's bytes, read block by block; none for anything else, a link
/// included, and for a file that cannot be read.
std::optional<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace lcs::bench
