/// \file
/// What was measured, group beside group: files, and a table to print.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/output.h"
#include "tools/likeness/measure.h"

namespace lcs::likeness {

/// Rows of one origin and name. All worlds are a group too, beside their families.
struct Group {
  Origin origin = Origin::recording;
  std::string name;
  std::size_t runs = 0, pairs = 0;
  /// 10, 25, 50, 75 and 90 % of each measure, by pairs; empty where none has it.
  std::array<std::vector<double>, kMeasures> quantiles;
};
/// Worlds, their families, suite, recordings; in each by the order of the rows.
std::vector<Group> groups_of(const std::vector<Row>& rows);

/// Medians, a line a group. A recording's is marked where it is not within what 80 in 100 of the
/// worlds' pairs have.
std::string text_of(const std::vector<Group>& groups);

/// likeness.csv with all rows, page.html with the groups.
bench::ResultNames likeness_files();
/// \throws bench::OutputError
void write_likeness(const std::filesystem::path& folder, const std::vector<Row>& rows);

}  // namespace lcs::likeness
