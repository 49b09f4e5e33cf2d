/// \file
/// `manifest.json`: the inputs and the generator of a sequence, and the SHA-256 of each of its
/// files. It is written last.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/input/input_file.h"
#include "tools/files/provenance.h"
#include "tools/sequence/self_check.h"

namespace lcs::sequence {

inline constexpr const char* kManifestFile = "manifest.json";

struct FileRecord {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// Agreements by the name of what was compared, as "flow_px".
using Agreements = std::map<std::string, Agreement>;

std::string manifest_text(const files::Provenance& plan, const Agreements& checks,
                          std::vector<FileRecord> files);

/// The provenance in a manifest, or in a file of its own. \throws input::Error
files::Provenance provenance_in(const std::filesystem::path& file);

/// The bytes of a file of a sequence. \throws input::Error
inline std::string read_file(const std::filesystem::path& path) {
  // the longest is a table of all frames
  return input::read_file(path, {16 * input::kGibibyte, "generate the sequence again"});
}

/// The paths of the files of a finished sequence, without the manifest. \throws input::Error, also
/// for a path that leads out of the sequence.
std::vector<std::string> files_in_manifest(const std::filesystem::path& manifest);

}  // namespace lcs::sequence
