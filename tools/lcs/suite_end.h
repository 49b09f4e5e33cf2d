/// \file
/// A suite on the terminal: its progress, and its end with tables and exit code, which `lcs suite`
/// and `lcs merge` share.
#pragma once

#include <memory>

#include "tools/app/suite.h"
#include "tools/lcs/command_line.h"

namespace lcs::tools {

struct SuiteEndOptions {
  bool fail_on_regression = false;  ///< exit with kRegressed if worse than the baseline
  bool worst_first = false;
  bool quiet = false;
};

/// Shows on stderr a line per finished run, and on a terminal a status line.
/// \param quiet prints nothing.
std::unique_ptr<app::SuiteWatch> suite_progress(bool quiet);

/// Adds `--fail-on-regression`, `--worst-first` and `--quiet`.
void add_suite_end(app::Options& all, SuiteEndOptions& options);

/// kRegressed, kError if nothing is judged, else kFine.
ExitCode exit_code_of(suite::Finding finding);

/// Prints the tables and messages of a suite.
ExitCode show_suite(const app::SuiteMade& made, const app::SuitePlace& place,
                    const SuiteEndOptions& options);

}  // namespace lcs::tools
