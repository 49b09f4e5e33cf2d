#include "tools/sequence/manifest.h"

#include <algorithm>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"

namespace lcs::sequence {

namespace fs = std::filesystem;

constexpr input::FileKind kManifestDocument{
    4 * input::kGibibyte,  // one file of each kind per frame, for a million frames
    "choose another folder with --out, or remove this one to make the sequence anew"};

std::string manifest_text(const files::Provenance& plan, const Agreements& checks,
                          std::vector<FileRecord> files) {
  std::ranges::sort(files, {}, &FileRecord::path);
  files::Json manifest;
  manifest["plan"] = plan.json();
  for (const auto& [name, agreement] : checks) {
    manifest["checks"][name] = {{"worst", agreement.worst}, {"compared", agreement.compared}};
  }
  for (const FileRecord& file : files) {
    manifest["files"][file.path] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  }
  return files::json_text(manifest, 1) + "\n";
}

files::Provenance provenance_in(const fs::path& file) {
  return files::read_json(file, kManifestDocument, [&](const files::JsonNode& node) {
    const bool is_manifest = file.filename() == kManifestFile;
    return files::Provenance::from(is_manifest ? node["plan"].json() : node.json());
  });
}

std::vector<std::string> files_in_manifest(const fs::path& manifest) {
  std::vector<std::string> paths;
  files::read_json(manifest, kManifestDocument, [&](const files::JsonNode& node) {
    node["files"].each_entry([&](const std::string& path, const files::JsonNode& record) {
      record.require(files::is_inner(path), "of a file inside of the sequence");
      paths.push_back(path);
    });
  });
  return paths;
}

}  // namespace lcs::sequence
