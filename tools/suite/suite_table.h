/// \file
/// A suite's result as a person reads it in a terminal.
#pragma once

#include <string>
#include <vector>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// A row a scenario (mean over seeds, and half the spread where it shows), then a row a group, then
/// what the columns are. At most 120 columns wide; a name that leaves no room has a line of its
/// own. \param worst_first by F1, errors before all; else as the suite has them.
std::string suite_table(const SuiteResult& suite, bool worst_first);

/// Errors and criteria that are not met, a line each; the same error of several seeds once.
std::vector<std::string> problems(const SuiteResult& suite);

/// What should not have been in a run, a line for each word of a scenario, with its seeds; the
/// text is that of the first of them.
std::vector<std::string> warnings(const SuiteResult& suite);

/// "12 passed, 1 failed, 0 errors".
std::string totals(const SuiteResult& suite);

}  // namespace lcs::suite
