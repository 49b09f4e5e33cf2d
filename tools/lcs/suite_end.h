/// \file
/// The end of a suite on the terminal: tables and exit code. `lcs suite` and `lcs merge` share it.
#pragma once

#include "tools/app/option.h"
#include "tools/app/suite_end.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct SuiteEndOptions {
  bool fail_on_regression = false;  ///< exit with kRegressed if worse than the baseline
  bool worst_first = false;
  bool quiet = false;
};

/// Adds `--fail-on-regression`, `--worst-first` and `--quiet`.
void add_suite_end(app::Options& all, SuiteEndOptions& options);

/// Prints the tables and messages of a suite.
ExitCode show_suite(const app::SuiteMade& made, const app::SuitePlace& place,
                    const SuiteEndOptions& options);

}  // namespace lcs::tools
