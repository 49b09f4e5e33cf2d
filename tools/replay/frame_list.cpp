#include "tools/replay/recorded.h"

#include <map>
#include <optional>

#include "tools/files/csv.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

using RowOfPicture = std::map<std::string, const TextTable::Row*>;

/// The rows by the names in a column; empty unless most rows name one of the pictures, with or
/// without its ending.
RowOfPicture rows_by_name(const TextTable& table, std::size_t column,
                          const std::map<std::string, std::string>& name_of_stem) {
  RowOfPicture rows;
  std::size_t found = 0;
  for (const TextTable::Row& row : table.rows) {
    const std::string name = fs::path(TextTable::field(row, column)).filename().string();
    const auto stem = name_of_stem.find(name);
    const bool is_stem = stem != name_of_stem.end();
    const std::string whole = is_stem ? stem->second : name;
    found += is_stem || name_of_stem.contains(fs::path(name).stem().string());
    rows.emplace(whole, &row);
  }
  return 2 * found > table.rows.size() ? rows : RowOfPicture{};
}

bool is_count(const TextTable& table, std::size_t column) {
  std::optional<long> before;
  for (const TextTable::Row& row : table.rows) {
    const auto number = files::number_in<long>(TextTable::field(row, column));
    if (!number || (before && *number != *before + 1)) return false;
    before = number;
  }
  return table.rows.size() > 1;
}

std::size_t time_column(const TextTable& table, std::optional<std::size_t> names) {
  const std::size_t columns = table.rows.front().fields.size();
  if (const auto named = table.time_column()) return *named;
  for (std::size_t i = 0; i < columns; ++i) {
    const bool is_number =
        files::number_in<double>(TextTable::field(table.rows.front(), i)).has_value();
    if (i != names && is_number && (columns == 1 || !is_count(table, i))) return i;
  }
  if (names) return *names;  // names that are times
  throw input::Error({table.file.string(), table.rows.front().line},
                     "no column holds times; give a time for each picture");
}

}  // namespace

void time_by_table(const fs::path& file, const std::string& time_unit, Recorded& recorded) {
  const TextTable table = read_table(file);
  if (table.rows.empty()) {
    throw input::Error({file.string(), 0}, "holds no time; give one for each picture");
  }
  std::map<std::string, std::string> name_of_stem;
  for (const RecordedFrame& frame : recorded.frames) {
    if (frame.picture.empty()) break;
    name_of_stem[frame.picture.stem().string()] = frame.picture.filename().string();
  }
  RowOfPicture rows;
  std::optional<std::size_t> names;
  for (std::size_t i = 0; i < table.rows.front().fields.size() && rows.empty(); ++i) {
    rows = rows_by_name(table, i, name_of_stem);
    if (!rows.empty()) names = i;
  }
  std::vector<std::optional<std::size_t>> row_of_frame;
  if (!names) row_of_frame = rows_of_frames(file, table.rows.size(), recorded);
  for (std::size_t i = 0; i < row_of_frame.size(); ++i) {
    if (row_of_frame[i]) continue;
    throw input::Error({file.string(), 0},
                       "has {} times for {} pictures, and none for {}; give one for each "
                       "picture, or a column with the names of the pictures",
                       table.rows.size(), recorded.frames.size(), recorded.frames[i].name());
  }
  const std::size_t column = time_column(table, names);
  const std::int64_t unit_ns = time_unit_of(
      table, column, time_unit, {kSlowestCamera_hz, kFastestCamera_hz, {}}, {}, recorded.tally);
  std::vector<RecordedFrame> timed;
  for (std::size_t i = 0; i < recorded.frames.size(); ++i) {
    RecordedFrame& frame = recorded.frames[i];
    const std::string name = frame.picture.filename().string();
    const auto found = rows.find(name);
    const TextTable::Row* row = !names                ? &table.rows[*row_of_frame[i]]
                                : found == rows.end() ? nullptr
                                                      : found->second;
    const auto t_ns = row ? time_in(TextTable::field(*row, column), unit_ns) : std::nullopt;
    if (row && !t_ns && !names) {
      throw input::Error({file.string(), row->line},
                         "holds no time, and the rows do not name their pictures; give one");
    }
    if (t_ns) {
      frame.t_ns = *t_ns;
      timed.push_back(frame);
    } else {
      recorded.tally.add("pictures have no time in the table and are left out", frame.name());
    }
  }
  recorded.frames = std::move(timed);
  put_in_order(recorded.frames, file, recorded.tally);
  recorded.timed = true;
  recorded.has_own_clock = false;
}

}  // namespace lcs::replay
