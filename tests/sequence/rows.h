/// \file
/// The rows of a generated table.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tools/files/csv.h"

namespace lcs::sequence {

/// The fields of each row, without lines that begin with '#'.
inline std::vector<std::vector<std::string>> rows_of(const std::filesystem::path& csv) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream file(csv);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::vector<std::string> row;
    for (const std::string_view field : files::fields_of(line)) row.emplace_back(field);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace lcs::sequence
