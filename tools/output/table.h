/// \file
/// The figures of a run as a short human-readable table.
#pragma once

#include <string>

#include "tools/scoring/scoring.h"

namespace lcs::bench {

/// One line each for rebels, objects, squares, size, time, and for how F1 was lost where it is
/// poor.
/// "-" marks an undefined figure. Ends with
/// a newline.
std::string table(const Metrics& metrics);

}  // namespace lcs::bench
