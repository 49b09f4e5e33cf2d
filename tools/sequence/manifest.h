/// \file
/// `manifest.json`: the inputs and the generator of a sequence, and the SHA-256 of each of its
/// files. It is written last.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/sequence/journal.h"

namespace lcs::sequence {

inline constexpr const char* kManifestFile = "manifest.json";

/// \param plan as for `Journal`.
std::string manifest_text(const std::string& plan, const Agreements& checks,
                          std::vector<FileRecord> files);

/// The JSON of a plan, or of a manifest. \throws input::Error
nlohmann::json read_plan(const std::filesystem::path& file);

/// The plan of a finished sequence; not an object if the file is not a manifest. \throws as above.
nlohmann::json plan_in_manifest(const std::filesystem::path& manifest);

/// The paths of the files of a finished sequence, without the manifest. \throws as `damage`.
std::vector<std::string> files_in_manifest(const std::filesystem::path& manifest);

/// Missing or changed files of a sequence, each with its fault.
/// \throws std::runtime_error for an unreadable manifest.
std::vector<std::string> damage(const std::filesystem::path& folder);

}  // namespace lcs::sequence
