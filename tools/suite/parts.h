/// \file
/// The parts of a suite that several machines make: choosing them, and joining their results.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/suite/suite_result.h"
#include "tools/suite/verdict.h"

namespace lcs::suite {

/// \param text as "3/16". \throws std::invalid_argument
Shard shard_of(const std::string& text);

/// The part of each run, 1 to `parts`, such that the parts take about equally long: the longest run
/// first, each to the part with the least so far. Equal inputs give equal parts on every machine.
/// \param seconds estimated duration of each run, >= 0.
std::vector<int> parts_of(const std::vector<double>& seconds, int parts);

/// The whole suite, as `lcs suite` without `--shard` gives it, with runs in the order of its plan.
/// The runs' folders stay as in the parts.
/// \param parts of one detector, at least one.
/// Their provenances (tools/files/provenance.h) agree: the caller has compared them.
/// \throws std::runtime_error that names the folders, if a suite is no part, the parts are of
///   different wholes, or runs are missing or there twice.
SuiteResult merge(std::span<const SuiteInFolder> parts);

}  // namespace lcs::suite
