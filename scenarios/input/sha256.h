/// \file
/// SHA-256 by OpenSSL.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace lcs::input {

/// 64 lower-case hexadecimal digits. \throws std::runtime_error if OpenSSL fails.
std::string sha256(std::string_view bytes);

/// The SHA-256 of a regular file, read block by block; absent if there is none, also for a link.
/// \throws Error for a file that cannot be read.
std::optional<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace lcs::input
