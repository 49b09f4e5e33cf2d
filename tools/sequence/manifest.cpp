#include "tools/sequence/manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/files/json_node.h"
#include "tools/files/sha256.h"
#include "tools/sequence/text_file.h"

namespace lcs::sequence {

namespace fs = std::filesystem;
// Keys in a readable order.
using Json = nlohmann::ordered_json;

std::string manifest_text(const std::string& plan, const Agreements& checks,
                          std::vector<FileRecord> files) {
  std::sort(files.begin(), files.end(),
            [](const FileRecord& a, const FileRecord& b) { return a.path < b.path; });
  Json manifest;
  manifest["plan"] = bench::parse_json<Json>(plan);
  for (const auto& [name, agreement] : checks) {
    manifest["checks"][name] = {{"worst", agreement.worst}, {"compared", agreement.compared}};
  }
  for (const FileRecord& file : files) {
    manifest["files"][file.path] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  }
  return manifest.dump(1) + "\n";
}

nlohmann::json read_plan(const fs::path& file) {
  return bench::parse_json<nlohmann::json>(
      read_file(file), {file.string(), 1},
      "choose another folder with --out, or remove this one to make the sequence anew");
}

nlohmann::json plan_in_manifest(const fs::path& manifest) {
  const nlohmann::json json = read_plan(manifest);
  return json.is_object() && json.contains("plan") ? json.at("plan") : nlohmann::json();
}

namespace {

/// Calls `take(path, SHA-256)` for each file in a manifest.
template <class Take>
void each_file(const fs::path& manifest, const Take& take) {
  // One file of each kind per frame, for a million frames.
  constexpr input::FileKind kManifestDocument{4 * input::kGibibyte,
                                              "remove the folder to make the sequence anew"};
  bench::read_json(manifest, kManifestDocument, [&](const bench::JsonNode& node) {
    node["files"].each_entry([&](const std::string& path, const bench::JsonNode& record) {
      take(path, record["sha256"].text());
    });
  });
}

}  // namespace

std::vector<std::string> files_in_manifest(const fs::path& manifest) {
  std::vector<std::string> paths;
  each_file(manifest, [&](const std::string& path, const std::string&) { paths.push_back(path); });
  return paths;
}

std::vector<std::string> damage(const fs::path& folder) {
  std::vector<std::string> damaged;
  each_file(folder / kManifestFile, [&](const std::string& path, const std::string& sha256) {
    std::error_code error;
    if (!fs::is_regular_file(folder / path, error)) {
      damaged.push_back(path + " is missing");
    } else if (bench::sha256_of_file(folder / path) != sha256) {
      damaged.push_back(path + " has other bytes than the manifest says");
    }
  });
  return damaged;
}

}  // namespace lcs::sequence
