#include "tools/replay/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <sstream>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"

namespace lcs::replay {
namespace {

/// The first of the separators in a line; ' ' stands for any number of blanks.
char separator_in(std::string_view line) {
  for (const char separator : {';', ',', '\t'}) {
    if (line.find(separator) != line.npos) return separator;
  }
  return ' ';
}

std::vector<std::string> fields_in(std::string_view line, char separator) {
  std::vector<std::string> fields;
  if (separator == ' ') {
    std::istringstream words{std::string(line)};
    for (std::string word; words >> word;) fields.push_back(word);
    return fields;
  }
  for (const std::string_view field : files::split(line, separator)) {
    fields.emplace_back(files::trimmed(field));
    // Tables with semicolons come from countries that write 0,5.
    if (separator == ';') std::ranges::replace(fields.back(), ',', '.');
  }
  return fields;
}

/// Removes the blanks before and inside brackets: "time [s] x [m s^-1]" has two fields.
std::string with_units_joined(std::string_view line) {
  std::string joined;
  int depth = 0;
  for (const char c : line) {
    if (c == '[' || c == '(') {
      while (!joined.empty() && joined.back() == ' ') joined.pop_back();
      ++depth;
    }
    joined += depth > 0 && c == ' ' ? '~' : c;
    if ((c == ']' || c == ')') && depth > 0) --depth;
  }
  return joined;
}

std::vector<TextTable::Column> columns_in(std::string_view line, char separator) {
  line.remove_prefix(std::min(line.find_first_not_of("#% \t"), line.size()));
  std::vector<TextTable::Column> columns;
  for (const std::string& field : fields_in(with_units_joined(line), separator)) {
    const std::size_t unit = field.find_first_of("[(");
    const std::size_t end = field.find_first_of("])", std::min(unit, field.size()));
    TextTable::Column column{std::string(files::trimmed(field.substr(0, unit))), ""};
    while (column.name.starts_with('#')) column.name = files::trimmed(column.name.substr(1));
    if (unit != field.npos) column.unit = field.substr(unit + 1, end - unit - 1);
    std::ranges::replace(column.unit, '~', ' ');
    columns.push_back(column);
  }
  return columns;
}

bool begins_with_number(std::string_view line) {
  const char c = line.front();
  return std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.';
}

}  // namespace

std::string TextTable::at(const Row& row) const {
  return fmt::format("{}:{}", file.string(), row.line);
}

std::string_view TextTable::field(const Row& row, std::size_t column) {
  return column < row.fields.size() ? std::string_view(row.fields[column]) : "";
}

std::optional<std::vector<double>> TextTable::numbers(const Row& row,
                                                      std::span<const std::size_t> columns) {
  std::vector<double> numbers;
  for (const std::size_t column : columns) {
    const auto number = files::number_in<double>(field(row, column));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<std::vector<double>> TextTable::numbers(const Row& row, std::size_t first,
                                                      std::size_t count) {
  if (row.fields.size() != first + count) return std::nullopt;
  std::vector<std::size_t> columns(count);
  std::iota(columns.begin(), columns.end(), first);
  return numbers(row, columns);
}

std::optional<std::size_t> TextTable::find(std::string_view name) const {
  const auto found = std::ranges::find(header, name, &Column::name);
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

std::optional<std::size_t> TextTable::time_column() const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    std::string name = header[i].name;
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool is_stamp = name.ends_with("header.stamp");
    const bool is_time =
        is_stamp || name.find("time") != name.npos || name == "t" || name.starts_with("stamp");
    if (is_stamp || (is_time && !found)) found = i;
    if (is_stamp) break;
  }
  return found;
}

std::size_t TextTable::column(std::string_view name, std::size_t otherwise) const {
  if (header.empty()) return otherwise;
  if (const auto found = find(name)) return *found;
  throw input::Error(
      {file.string(), 1},
      "the header names no column {}; give each column the name that the layout has for it", name);
}

TextTable read_table(const fs::path& file) {
  // An hour of a 1 kHz IMU takes 400 MB.
  constexpr input::FileKind kSensorTable{input::kGibibyte,
                                         "give a table of rows, as the layout has it"};
  input::InputFile input(file, kSensorTable);
  TextTable table{file, ' ', {}, {}};
  std::vector<std::string> before;  // lines before the first row
  for (std::string text; input.next_line(text);) {
    const std::string_view line = files::trimmed(text);
    if (line.empty()) continue;
    if (table.rows.empty() && !begins_with_number(line)) {
      before.emplace_back(line);
      continue;
    }
    if (line.starts_with('#')) continue;
    if (table.rows.empty()) table.separator = separator_in(line);
    table.rows.push_back({input.here().line, fields_in(line, table.separator)});
  }
  if (before.empty()) return table;
  if (table.rows.empty()) table.separator = separator_in(before.back());
  for (const std::string& line : before) {
    std::vector<TextTable::Column> columns = columns_in(line, table.separator);
    const bool is_bare = !line.starts_with('#');
    const bool fits = !table.rows.empty() && columns.size() == table.rows[0].fields.size();
    if (fits || is_bare || table.rows.empty()) table.header = std::move(columns);
  }
  return table;
}

}  // namespace lcs::replay
