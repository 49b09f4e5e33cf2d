/// \file
/// Joins the parts of a suite that several machines made.
#pragma once

#include <span>

#include "tools/suite/suite_result.h"
#include "tools/suite/verdict.h"

namespace lcs::suite {

/// The whole suite, as `lcs suite` without `--shard` gives it, with runs in the order of its plan.
/// The runs' folders stay as in the parts.
/// \param parts of one detector, at least one.
/// \throws std::runtime_error that names the folders, if a suite is no part, the parts differ in
///   their detector, settings, program, frames or plan, or runs are missing or there twice.
SuiteResult merge(std::span<const SuiteInFolder> parts);

}  // namespace lcs::suite
