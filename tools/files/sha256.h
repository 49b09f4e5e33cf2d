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

/// The SHA-256 of a regular file, read block by block; absent for anything else, including a link,
/// and for an unreadable file.
std::optional<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace lcs::bench
