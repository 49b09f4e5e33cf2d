#include "tools/replay/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

#include "tools/files/csv.h"
#include "tools/input/input_file.h"

namespace lcs::replay {
namespace {

std::vector<std::string> split(std::string_view line, char separator) {
  std::vector<std::string> fields;
  if (separator == ',') {
    for (const std::string_view field : bench::fields_of(line)) fields.emplace_back(field);
    return fields;
  }
  std::istringstream words{std::string(line)};
  for (std::string word; words >> word;) fields.push_back(word);
  return fields;
}

/// A column's name: "timestamp" for "#timestamp [ns]".
std::string name_of(std::string_view field) {
  const std::size_t unit = field.find('[');
  std::string_view name = bench::trimmed(field.substr(0, unit));
  while (name.starts_with('#')) name = bench::trimmed(name.substr(1));
  return std::string(name);
}

bool begins_with_number(std::string_view line) {
  const char c = line.front();
  return std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.';
}

}  // namespace

std::string TextTable::at(const Row& row) const {
  return fmt::format("{}:{}", file.string(), row.line);
}

std::size_t TextTable::column(std::string_view name, std::size_t otherwise) const {
  if (header.empty()) return otherwise;
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) {
    throw input::Error({file.string(), 1},
                       fmt::format("the header names no column {}; give each column the name "
                                   "that the layout has for it",
                                   name));
  }
  return static_cast<std::size_t>(found - header.begin());
}

TextTable read_table(const std::filesystem::path& file, char separator) {
  // An hour of a 1 kHz IMU takes 400 MB.
  constexpr input::FileKind kSensorTable{input::kGibibyte,
                                         "give a table of rows, as the layout has it"};
  input::InputFile input(file, kSensorTable);
  TextTable table{file, {}, {}};
  for (std::string text; input.next_line(text);) {
    const std::string_view line = bench::trimmed(text);
    if (line.empty()) continue;
    const bool is_first = table.rows.empty() && table.header.empty();
    if (is_first && !begins_with_number(line)) {
      for (const std::string& field : split(line, separator)) {
        table.header.push_back(name_of(field));
      }
    } else if (!line.starts_with('#')) {
      table.rows.push_back({input.here().line, split(line, separator)});
    }
  }
  return table;
}

}  // namespace lcs::replay
