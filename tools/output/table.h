/// \file
/// The figures of a run as a person reads them, in five seconds.
#pragma once

#include <string>

#include "tools/scoring/scoring.h"

namespace lcs::bench {

/// A line for each of rebels, objects, squares, size, time. "-" for an undefined figure; ends with
/// a line end.
std::string table(const Metrics& metrics);

}  // namespace lcs::bench
