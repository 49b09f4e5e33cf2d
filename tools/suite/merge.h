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
/// Their provenances (tools/files/provenance.h) agree: the caller has compared them.
/// \throws std::runtime_error that names the folders, if a suite is no part, the parts are of
///   different wholes, or runs are missing or there twice.
SuiteResult merge(std::span<const SuiteInFolder> parts);

}  // namespace lcs::suite
