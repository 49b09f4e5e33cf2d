/// \file
/// `lcs suite`: runs many scenarios with several seeds each in parallel and prints one table.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/lcs/detector_option.h"
#include "tools/lcs/exit_codes.h"
#include "tools/lcs/suite_end.h"
#include "tools/lcs/suite_worlds.h"

namespace lcs::tools {

struct SuiteOptions {
  std::vector<std::string> paths;    ///< scenario files and folders; empty: the project's own
  std::optional<std::string> group;  ///< absent: all for named paths, else `short`
  std::string filter;                ///< regular expression that names must match
  int jobs = 0;                      ///< concurrent runs; 0: one per processor
  std::optional<int> seeds;          ///< per scenario; absent: 3, for worlds 1
  WorldsOptions worlds;              ///< worlds to run instead of scenario files
  DetectorOptions detector;
  std::vector<std::string> sets;    ///< "key=value"
  std::vector<std::string> beside;  ///< further detectors on the same frames
  std::string recorded;             ///< earlier suite's folder, for its frames; "": simulate
  bench::Keep keep = bench::Keep::all;
  std::string shard;  ///< "2/5": only the second of five parts; "": all
  std::string times;  ///< earlier suite whose durations balance the parts; "": none
  bool anew = false;  ///< drop the runs of an unfinished suite
  bool list = false;
  SuiteEndOptions end;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_suite_command(CLI::App& app, SuiteOptions& options);

/// \throws bench::OutputError, Interrupted, std::exception; then no suite is written, and an
///   earlier suite is unchanged. Finished runs are kept, and the same command goes on from there.
ExitCode suite(const SuiteOptions& options);

}  // namespace lcs::tools
