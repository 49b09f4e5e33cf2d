/// \file
/// Text tables from other tools: any line ends, any of the usual separators, an optional header.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lcs::replay {

namespace fs = std::filesystem;

struct TextTable {
  struct Column {
    std::string name;  ///< without '#', '%', unit and blanks round it
    std::string unit;  ///< in brackets behind the name, as "rad s^-1"; "": none stated
  };
  struct Row {
    int line = 0;  ///< from 1
    std::vector<std::string> fields;
  };

  fs::path file;
  char separator = ' ';        ///< comma, semicolon, tab; ' ': any number of blanks
  std::vector<Column> header;  ///< empty if there is no header
  bool is_comment = false;     ///< the header is behind '#', '%' or '//': perhaps it is none
  std::vector<Row> rows;

  /// For messages: "its columns are a, b, c", or how many there are without a header.
  std::string columns() const;
  /// "file:line"
  std::string at(const Row& row) const;
  /// The field of a row; "" if the row is shorter.
  static std::string_view field(const Row& row, std::size_t column);
  /// The numbers in columns of a row; absent unless all are there.
  static std::optional<std::vector<double>> numbers(const Row& row,
                                                    std::span<const std::size_t> columns);
  /// The fields of a row from `first` on; absent unless they are `count` numbers.
  static std::optional<std::vector<double>> numbers(const Row& row, std::size_t first,
                                                    std::size_t count);

  /// \param name without regard to case.
  std::optional<std::size_t> find(std::string_view name) const;
  /// The column that the header calls a time: the stamp of a ROS header, or the first one.
  std::optional<std::size_t> time_column() const;
  /// Index of the column called `name`, or `otherwise` without a header.
  /// \throws input::Error if there is a header without it.
  std::size_t column(std::string_view name, std::size_t otherwise) const;
};

/// ASCII letters only.
std::string in_lower_case(std::string_view text);

/// The words of a column's name in lower case: "gyroRotationX" is gyro, rotation, x.
std::vector<std::string> words_in(std::string_view name);

/// Two quantities of three or four components, by words in the names of their columns.
struct Quantities {
  std::set<std::string> first, second, others;  ///< "": a name of the component alone

  /// 0 to 2 for x, y, z of the first, 3 to 6 for x, y, z, w of the second; absent for other
  /// columns.
  std::optional<std::size_t> place_of(std::string_view name) const;
};

/// Reads fields between commas, semicolons (with decimal commas), tabs or blanks, whichever the
/// first row of numbers has. Of the lines before that row the last one that has as many fields is
/// the header; empty lines and further lines that begin with '#' are skipped.
/// \throws input::Error if the file cannot be read, or is of a tool whose tables are not read.
TextTable read_table(const fs::path& file);

}  // namespace lcs::replay
