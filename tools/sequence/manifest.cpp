#include "tools/sequence/manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"

namespace lcs::sequence {

namespace fs = std::filesystem;
// Keys in a readable order.
using Json = nlohmann::ordered_json;

constexpr input::FileKind kManifestDocument{
    4 * input::kGibibyte,  // one file of each kind per frame, for a million frames
    "choose another folder with --out, or remove this one to make the sequence anew"};

std::string manifest_text(const bench::Provenance& plan, const Agreements& checks,
                          std::vector<FileRecord> files) {
  std::sort(files.begin(), files.end(),
            [](const FileRecord& a, const FileRecord& b) { return a.path < b.path; });
  Json manifest;
  manifest["plan"] = plan.json();
  for (const auto& [name, agreement] : checks) {
    manifest["checks"][name] = {{"worst", agreement.worst}, {"compared", agreement.compared}};
  }
  for (const FileRecord& file : files) {
    manifest["files"][file.path] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  }
  return bench::json_text(manifest, 1) + "\n";
}

bench::Provenance read_provenance(const fs::path& file) {
  return bench::read_json(file, kManifestDocument, [](const bench::JsonNode& node) {
    return bench::Provenance::from(node.json());
  });
}

bench::Provenance provenance_in(const fs::path& manifest) {
  return bench::read_json(manifest, kManifestDocument, [](const bench::JsonNode& node) {
    return bench::Provenance::from(node["plan"].json());
  });
}

std::vector<std::string> files_in_manifest(const fs::path& manifest) {
  std::vector<std::string> paths;
  bench::read_json(manifest, kManifestDocument, [&](const bench::JsonNode& node) {
    node["files"].each_entry([&](const std::string& path, const bench::JsonNode& record) {
      record.require(bench::is_inner(path), "of a file inside of the sequence");
      paths.push_back(path);
    });
  });
  return paths;
}

}  // namespace lcs::sequence
