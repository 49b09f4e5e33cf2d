/// \file
/// The provenance of a result: everything that determined its bytes. It is a part of `run.json` in
/// a folder of results, of `manifest.json` in a sequence, and the head of a journal. Work goes on,
/// and parts are joined, only if their provenances agree.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "tools/files/json_node.h"

namespace lcs::files {

struct Provenance {
  /// Settings, program, versions and so on, by name.
  Json facts = Json::object();
  /// SHA-256 of each file that was read, by its path: relative to the working folder if it lies in
  /// it, so that it is the same on machines that work in copies of one folder. In a sequence,
  /// relative to the folder of its scenario.
  std::map<std::string, std::string> read = {};

  /// Facts, then "read".
  Json json() const;
  /// From the output of `json`, also beside the command, date and seconds of `run.json`.
  /// \throws JsonNode::Error
  static Provenance from(const Json& json);

  /// Adds the files that a unit of the work has read, such as a run of a suite.
  /// \param unit names it in the message.
  /// \throws std::runtime_error if both have read a file, but in different states.
  void add_read(const Provenance& of_unit, const std::string& unit);
};

/// With the files that this process has read so far (scenarios/input/inputs_read.h), without the
/// outputs that it writes. \param base absolute folder of the paths; "": the working folder.
Provenance provenance_of(Json facts, const std::filesystem::path& base = {});

/// The file with the provenance in a folder of results (tools/app/how_made.h).
inline constexpr const char* kHowMadeFile = "run.json";

/// The provenance of a result. \param folder of the result, with its run.json.
/// \throws input::Error, also for a result of an earlier version, which has no such record.
Provenance read_how_made(const std::filesystem::path& folder);

/// The first difference, such as "keep differs ('figures' and 'all')" or "scenes/lab.xml differs";
/// "" if there is none. Of the files, only those that both have read can differ.
/// \param but names of facts that may differ.
std::string difference(const Provenance& a, const Provenance& b,
                       std::span<const std::string_view> but = {});

/// The first file that is no longer as it was read, such as "scenes/lab.xml was changed since" or
/// "... is missing"; "" if there is none. \param base as of `provenance_of`.
std::string changed_since(const Provenance& provenance, const std::filesystem::path& base = {});

}  // namespace lcs::files
