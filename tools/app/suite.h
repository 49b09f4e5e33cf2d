/// \file
/// Runs many scenarios with several seeds each, in parallel, and sums them up; and joins the parts
/// of such a suite.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/app/caller.h"
#include "tools/app/option.h"
#include "tools/app/run.h"
#include "tools/app/world.h"
#include "tools/files/output.h"
#include "tools/files/provenance.h"
#include "tools/suite/comparison.h"
#include "tools/suite/plan.h"
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

struct SuiteRequest {
  std::vector<std::string> paths;    ///< scenario files and folders; empty: the project's own
  std::optional<std::string> group;  ///< absent: all for named paths, else `short`
  std::string filter;                ///< regular expression that names must match
  int jobs = 0;                      ///< concurrent runs; 0: one per processor
  std::optional<int> seeds;          ///< per scenario; absent: 3, for worlds 1
  WorldsChoice worlds;               ///< worlds to run instead of scenario files
  DetectorChoice detector;
  std::vector<std::string> sets;    ///< "key=value"
  std::vector<std::string> beside;  ///< further detectors on the same frames
  std::string recorded;             ///< earlier suite's folder, for its frames; "": simulate
  output::Keep keep = output::Keep::all;
  std::string shard;  ///< "2/5": only the second of five parts; "": all
  std::string times;  ///< earlier suite whose durations balance the parts; "": none
  bool anew = false;  ///< drop the runs of an unfinished suite
  bool all = false;   ///< make all runs, also if the verdict against the baseline is certain before
  SuitePlace place;
};

Options options_of(SuiteRequest& request);

/// The planned runs, and of which whole they are a part.
struct SuitePlan {
  std::vector<suite::PlannedScenario> plan;
  std::optional<suite::PartOf> part_of;
};

/// The runs of a request. Missing worlds are drawn first. \throws as `suite::plan`.
SuitePlan plan_suite(const SuiteRequest& request, Caller& caller);

/// A suite that is written.
struct SuiteMade {
  suite::SuiteResult result;
  std::vector<suite::SuiteResult> others;       ///< of the detectors of `beside`
  std::optional<suite::Comparison> comparison;  ///< with the baseline, if there is one
  suite::SuiteVerdict verdict;
  std::filesystem::path folder;
};

/// \throws files::OutputError, std::exception, and an exception of `caller.check`; then no suite is
///   written, and an earlier suite is unchanged. Finished runs are kept, and the same request goes
///   on from there.
SuiteMade suite(const SuiteRequest& request, Caller& caller);

/// Joins the parts of a suite that were made with `SuiteRequest::shard`.
struct MergeRequest {
  std::vector<std::string> parts;  ///< folders
  SuitePlace place;
};

Options options_of(MergeRequest& request);

/// \throws files::OutputError, std::exception; then nothing is written.
SuiteMade merge(const MergeRequest& request, Caller& caller);

/// \name The end of a suite, which `suite` and `merge` share
///@{
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
///@}

}  // namespace lcs::app
