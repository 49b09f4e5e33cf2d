/// \file
/// A suite's result as text for a terminal, and tables that compare its detector with others on the
/// same runs.
#pragma once

#include <span>
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

/// F1 of rebel corners (mean over seeds): a row per scenario with a figure by every detector, and
/// the means over each group and over all. Then a line per other detector: the number of scenarios
/// in which the suite's detector is ahead, the scenario with the least lead, and the ratio of the
/// step times (mean over scenarios of the ratio of medians).
/// For worlds, the means have 95 % intervals, and two blocks follow: the lead over each other
/// detector, paired by world; and the false objects in static worlds and in all worlds.
std::string beside_table(const SuiteResult& suite, std::span<const SuiteResult> others);

inline constexpr const char* kStandingFile = "standing.md";

/// A Markdown table with a row per detector: F1 and recall of rebel corners, recall of movers'
/// boxes, false objects, and times of a frame. Each is a mean over the scenarios that have the
/// figure, for worlds (times apart) with the 95 % interval, `±`. An undefined figure is `-`.
std::string standing_table(const SuiteResult& suite, std::span<const SuiteResult> others);

}  // namespace lcs::suite
