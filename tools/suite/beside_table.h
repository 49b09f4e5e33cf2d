/// \file
/// A suite beside the same suite with other detectors: a score without a yardstick means nothing.
#pragma once

#include <span>
#include <string>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// F1 of rebel corners (mean over seeds), a row a scenario that has it by every detector, and their
/// means over each group and over all. Then a line for each other detector: in how many scenarios
/// the suite's is ahead of it, where it is least so, and how long its step takes beside the other's
/// (mean over scenarios of the ratio of medians).
/// Over worlds, the means have their 95 % interval, and two more blocks follow: by how much the
/// suite's detector is ahead of each other one, paired by world; and the false objects where
/// nothing moves, and in all worlds.
std::string beside_table(const SuiteResult& suite, std::span<const SuiteResult> others);

inline constexpr const char* kStandingFile = "standing.md";

/// A table in Markdown, a row a detector: means over all scenarios that have the figure (of worlds
/// with their 95 % interval, `±`) of F1 and recall of rebel corners, of recall of boxes of movers,
/// and of false objects, and without an interval of the time of a frame. What nobody knows is `-`.
std::string standing_table(const SuiteResult& suite, std::span<const SuiteResult> others);

}  // namespace lcs::suite
