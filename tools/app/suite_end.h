/// \file
/// The end of a suite: its files. `app::suite` and `app::merge` share it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/app/caller.h"
#include "tools/files/output.h"
#include "tools/files/provenance.h"
#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"
#include "tools/suite/verdict.h"

namespace lcs::app {

struct SuitePlace {
  static constexpr const char* kDefault = "out/suite";
  std::string out = kDefault;  ///< folder
  std::string baseline;        ///< suite.json or its folder; "": none
  bool allow_missing = false;  ///< judges though runs of the baseline are missing

  bool is_named() const { return out != kDefault; }
};

/// A suite that is written.
struct SuiteMade {
  suite::SuiteResult result;
  std::vector<suite::SuiteResult> others;       ///< of the detectors of `beside`
  std::optional<suite::Comparison> comparison;  ///< with the baseline, if there is one
  suite::SuiteVerdict verdict;
  std::filesystem::path folder;
};

/// The baseline of a place. \throws std::runtime_error if it cannot be read.
std::optional<suite::SuiteResult> baseline_of(const SuitePlace& place);

/// A warning if two suites have read different states of a file, such as a scene, so that a
/// difference of their figures has that cause, too; empty if not. \param before, after folders.
std::vector<std::string> other_inputs(const std::filesystem::path& before,
                                      const std::filesystem::path& after);

/// The folder of a detector's results, relative to the suite's folder.
std::filesystem::path part_of(const std::string& detector, const std::string& own);

/// Adds to the facts of a suite's provenance what differs between its parts.
void add_part(files::Json& facts, const std::string& shard, const suite::SuiteRuns& runs);

/// The names of these facts.
inline constexpr std::array<std::string_view, 3> kFactsOfParts{"shard", "runs", "scenarios"};

/// Writes suite.json, junit.xml, the report and so on, and commits the folder.
/// \param folder has the runs, and for worlds their pictures.
/// \param others the results of the detectors of `beside`.
/// \throws files::OutputError, std::runtime_error
SuiteMade finish_suite(files::Output& folder, const SuitePlace& place, suite::SuiteResult result,
                       std::vector<suite::SuiteResult> others,
                       const std::optional<suite::SuiteResult>& baseline, Caller& caller);

}  // namespace lcs::app
