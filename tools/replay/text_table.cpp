#include "tools/replay/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <sstream>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"
#include "tools/replay/picture_names.h"
#include "tools/replay/times.h"

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

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

/// Begins with a number; or with a word, and most fields are numbers; or with the name of a
/// picture, and another field is a number.
bool is_row(std::string_view line) {
  const char c = line.front();
  if (std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.') return true;
  const std::vector<std::string> fields = fields_in(line, separator_in(line));
  const auto numbers = std::ranges::count_if(
      fields, [](const std::string& field) { return files::number_in<double>(field).has_value(); });
  if (is_comment(line)) return false;
  return is_picture(fields[0]) ? numbers > 0 : numbers > 2 && 2 * numbers > std::ssize(fields);
}

/// A table of a tool that needs more than other names of columns.
struct Foreign {
  std::string_view words;  ///< in a line before its rows
  const char *name, *header;
};
constexpr Foreign kForeign[] = {
    {"x_world_device", "Project Aria's, with poses of the device",
     "uid,time [us],utc,p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_x,q_RS_y,q_RS_z,q_RS_w and its other "
     "names"},
    {"vehiclename", "AirSim's, with poses of the vehicle (x ahead, y right, z down)",
     "name,time,p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z,file, with its tabs"},
    {"qz,tx_m", "Argoverse 2's, with poses of the vehicle (x ahead, y left, z up)",
     "time [ns],q_RS_w,q_RS_x,q_RS_y,q_RS_z,p_RS_R_x,p_RS_R_y,p_RS_R_z"},
    {"image_id, qw", "COLMAP's: it has no times, and poses of the world in the camera",
     "time,x,y,z,qx,qy,qz,qw over inverse poses, or give the folder of its pictures and fps"},
    {"tscale", "Gyroflow's, in other axes and units (orientation, tscale, gscale, ascale)",
     "time [s],w_RS_S_x,w_RS_S_y,w_RS_S_z,a_RS_S_x [g],a_RS_S_y [g],a_RS_S_z [g] over its readings "
     "in these"},
};

void refuse_foreign(const fs::path& file, const std::vector<std::string>& before) {
  for (const std::string& line : before) {
    for (const Foreign& one : kForeign) {
      if (in_lower_case(line).find(one.words) == line.npos) continue;
      throw input::Error({file.string(), 0}, "this table is {}; for its header write {}{}",
                         one.name, one.header,
                         std::string_view(one.header).find("p_RS") < 60
                             ? ", and give the camera's place there by a calibration"
                             : "");
    }
  }
}

}  // namespace

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::vector<std::string> words_in(std::string_view name) {
  std::vector<std::string> words;
  unsigned char before = ' ';
  for (const unsigned char c : name) {
    const bool begins = !std::isalpha(before) || (std::isupper(c) && std::islower(before));
    if (std::isalpha(c) && begins) words.emplace_back();
    if (std::isalpha(c)) words.back() += static_cast<char>(std::tolower(c));
    before = c;
  }
  return words;
}

std::optional<std::size_t> Quantities::place_of(std::string_view name) const {
  std::vector<std::string> words = words_in(name);
  if (words.empty()) return std::nullopt;
  const std::size_t axis = std::string_view("xyzw").find(words.back().back());
  words.back().pop_back();
  if (words.size() > 1 && words.back().empty()) words.pop_back();
  const auto any = [&](const std::set<std::string>& of) {
    return std::ranges::any_of(words, [&](const std::string& word) { return of.contains(word); });
  };
  const bool is_second = any(second);
  const std::size_t most = is_second ? 3 : 2;
  if (axis > most || any(others) || any(first) == is_second) return std::nullopt;
  return axis + (is_second ? 3 : 0);
}

std::string TextTable::columns() const {
  if (header.empty())
    return fmt::format("it has {} columns and no header", rows.front().fields.size());
  std::vector<std::string> names;
  for (const Column& column : header) names.push_back(column.name);
  return fmt::format("its columns are {}", fmt::join(names, ", "));
}

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
  const auto found = std::ranges::find(
      header, in_lower_case(name), [](const Column& column) { return in_lower_case(column.name); });
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

std::optional<std::size_t> TextTable::time_column() const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string name = in_lower_case(header[i].name);
    std::vector<std::string> words = words_in(name);
    const bool is_stamp = name.ends_with("header.stamp");
    // a unit alone, or behind t or ts
    if (words.size() > 1 && time_unit_named(words.back())) words.pop_back();
    const bool is_short =
        words.size() == 1 && (words[0] == "t" || words[0] == "ts" || time_unit_named(words[0]));
    const bool is_time = is_stamp || is_short || name.find("time") != name.npos ||
                         name.find("stamp") != name.npos || name.find("epoch") != name.npos;
    const bool is_span = name.find("exposure") != name.npos;
    if (is_stamp || (is_time && !is_span && !found)) found = i;
    if (is_stamp) break;
  }
  return found;
}

std::size_t TextTable::column(std::string_view name, std::size_t otherwise) const {
  if (header.empty()) return otherwise;
  if (const auto found = find(name)) return *found;
  throw input::Error(
      {file.string(), 1},
      "the header names no column {}: {}; give each column the name that the layout has for it",
      name, columns());
}

TextTable read_table(const fs::path& file) {
  // An hour of a 1 kHz IMU takes 400 MB.
  constexpr input::FileKind kSensorTable{input::kGibibyte,
                                         "give a table of rows, as the layout has it"};
  input::InputFile input(file, kSensorTable);
  TextTable table{file, ' ', {}, false, {}};
  std::vector<std::string> before;  // lines before the first row
  for (std::string text; input.next_line(text);) {
    const std::string_view line = files::trimmed(text);
    if (line.empty()) continue;
    if (table.rows.empty() && !is_row(line)) {
      before.emplace_back(line);
      continue;
    }
    if (line.starts_with('#')) continue;
    if (table.rows.empty()) table.separator = separator_in(line);
    table.rows.push_back({input.here().line, fields_in(line, table.separator)});
  }
  if (before.empty()) return table;
  refuse_foreign(file, before);
  if (table.rows.empty()) table.separator = separator_in(before.back());
  for (const std::string& line : before) {
    std::vector<TextTable::Column> columns = columns_in(line, table.separator);
    const bool is_bare = !is_comment(line);
    const bool fits = !table.rows.empty() && columns.size() == table.rows[0].fields.size();
    if (!fits && !is_bare && !table.rows.empty()) continue;
    table.header = std::move(columns);
    table.is_comment = !is_bare;
  }
  return table;
}

}  // namespace lcs::replay
