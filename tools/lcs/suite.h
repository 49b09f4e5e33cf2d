/// \file
/// `lcs suite`: many scenarios with several seeds each, in parallel, told in one table.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/lcs/detector_option.h"
#include "tools/lcs/exit_codes.h"
#include "tools/lcs/suite_worlds.h"

namespace lcs::tools {

struct SuiteOptions {
  std::vector<std::string> paths;    ///< scenario files and folders; none: the project's own
  std::optional<std::string> group;  ///< none: `short` for folders, all for files
  std::string filter;                ///< regular expression for names
  int jobs = 0;                      ///< runs at a time; 0: as many as there are processors
  std::optional<int> seeds;          ///< none: 3, of worlds 1
  WorldsOptions worlds;              ///< to run in place of scenario files
  DetectorOptions detector;
  std::vector<std::string> sets;    ///< "key=value"
  std::vector<std::string> beside;  ///< other detectors to run too
  std::string recorded;             ///< folder of an earlier suite, for its frames; "": simulate
  std::string out = "out/suite";    ///< folder
  std::string baseline;             ///< suite.json, or its folder; "" for none
  bool fail_on_regression = false;  ///< against the baseline
  bool worst_first = false;
  bool list = false;
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_suite_command(CLI::App& app, SuiteOptions& options);

/// \throws bench::OutputError, Interrupted, std::exception; then there is no new suite, and an
///   earlier one is as it was.
ExitCode suite(const SuiteOptions& options);

}  // namespace lcs::tools
