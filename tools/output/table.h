/// \file
/// The figures of a run: a short text, or a table of all.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/scoring/scoring.h"
#include "tools/scoring/table.h"

namespace lcs::output {

/// One line each for rebels, objects, squares, size and time, and below an F1 of 0.7 for how F1 was
/// lost. "-" marks an undefined figure. Ends with a newline.
std::string table(const scoring::Metrics& metrics);

/// A row for each figure that any detector has, with its unit. \param detectors names and figures.
scoring::FigureTable figure_table(
    const std::vector<std::pair<std::string, scoring::Metrics>>& detectors);

}  // namespace lcs::output
