/// \file
/// Runs many scenarios with several seeds each, in parallel, and sums them up.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/app/caller.h"
#include "tools/app/option.h"
#include "tools/app/run.h"
#include "tools/app/suite_end.h"
#include "tools/app/suite_worlds.h"
#include "tools/suite/plan.h"

namespace lcs::app {

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

}  // namespace lcs::app
