/// \file
/// The figures of a run as a short human-readable table.
#pragma once

#include <string>

#include "tools/scoring/scoring.h"

namespace lcs::output {

/// One line each for rebels, objects, squares, size and time, and below an F1 of 0.7 for how F1 was
/// lost. "-" marks an undefined figure. Ends with a newline.
std::string table(const scoring::Metrics& metrics);

}  // namespace lcs::output
