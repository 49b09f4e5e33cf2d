/// \file
/// Text tables from other tools: any line ends, spaces round fields, an optional header.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lcs::replay {

struct TextTable {
  std::filesystem::path file;
  /// Names of columns, without '#', units in brackets and spaces; empty if there is no header.
  std::vector<std::string> header;
  struct Row {
    int line = 0;  ///< from 1
    std::vector<std::string> fields;
  };
  std::vector<Row> rows;

  /// "file:line"
  std::string at(const Row& row) const;

  /// Index of the column called `name`, or `otherwise` without a header.
  /// \throws std::runtime_error if there is a header without it.
  std::size_t column(std::string_view name, std::size_t otherwise) const;
};

/// Skips empty lines. A first line that does not begin with a number is the header; further lines
/// that begin with '#' are skipped.
/// \param separator ',', or ' ' for any number of spaces and tabs.
/// \throws input::Error if the file cannot be read.
TextTable read_table(const std::filesystem::path& file, char separator);

}  // namespace lcs::replay
