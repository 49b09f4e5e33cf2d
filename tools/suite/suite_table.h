/// \file
/// A suite's result as text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// A row per scenario (mean over seeds and, if it shows, half the range), a row per group, and a
/// legend. At most 120 columns wide; a long name has a line of its own.
/// \param worst_first sorts by F1, errors first; otherwise in the suite's order.
std::string suite_table(const SuiteResult& suite, bool worst_first);

/// A line per error and unmet criterion. Equal messages of several seeds share a line.
std::vector<std::string> problems(const SuiteResult& suite);

/// The runs' warnings, a line per scenario and kind of warning, with the seeds; the text is the
/// first seed's.
std::vector<std::string> warnings(const SuiteResult& suite);

}  // namespace lcs::suite
