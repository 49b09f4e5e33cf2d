#include "tools/replay/recorded.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "tools/files/csv.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

/// The row of each frame; null for a frame without one.
using RowOfFrame = std::vector<const TextTable::Row*>;

/// The rows by the names or numbers of pictures in a column; empty unless most rows name one, with
/// or without its ending, or each picture has a row with its number. \throws input::Error if two
/// rows name one picture, in other folders.
RowOfFrame rows_by_name(const TextTable& table, std::size_t column,
                        const std::vector<RecordedFrame>& frames) {
  std::map<std::string, std::size_t> frame_of_stem;
  std::map<std::size_t, std::size_t> frame_of_number;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].picture.empty()) frame_of_stem[frames[i].picture.stem().string()] = i;
    if (frames[i].named) frame_of_number[*frames[i].named] = i;
  }
  RowOfFrame by_name(frames.size()), by_number(frames.size());
  std::size_t named = 0, numbered = 0;
  for (const TextTable::Row& row : table.rows) {
    const std::string_view field = TextTable::field(row, column);
    const fs::path name = field;
    auto found = frame_of_stem.find(name.filename().string());
    if (found == frame_of_stem.end()) found = frame_of_stem.find(name.stem().string());
    if (found != frame_of_stem.end()) {
      const auto is_here = [&](const TextTable::Row& of) {
        const std::string whole = fmt::format("/{}", frames[found->second].picture.string());
        return whole.ends_with(fmt::format("/{}", TextTable::field(of, column)));
      };
      const TextTable::Row*& other = by_name[found->second];
      ++named;
      if (!other || (is_here(row) && !is_here(*other))) {
        other = &row;
      } else if (!is_here(*other) && TextTable::field(*other, column) != field) {
        throw input::Error(
            {table.file.string(), row.line},
            "{} and {} may both be the picture {}; give the rows of its folder alone",
            TextTable::field(*other, column), field, frames[found->second].name());
      }
    }
    const auto number = files::number_in<std::size_t>(field);
    const auto at = number ? frame_of_number.find(*number) : frame_of_number.end();
    if (at != frame_of_number.end()) numbered += !std::exchange(by_number[at->second], &row);
  }
  if (2 * named > table.rows.size()) return by_name;
  return numbered == frames.size() ? by_number : RowOfFrame{};
}

/// Whether a column holds the numbers 0 or 1 to N, in any order.
bool is_count(const TextTable& table, std::size_t column) {
  std::set<long> numbers;
  for (const TextTable::Row& row : table.rows) {
    const auto number = files::number_in<long>(TextTable::field(row, column));
    if (!number || !numbers.insert(*number).second) return false;
  }
  return numbers.size() > 1 && *numbers.rbegin() - *numbers.begin() == std::ssize(numbers) - 1;
}

/// Whether a column has numbers that increase from picture to picture, except for a tenth of them.
bool increases(const RowOfFrame& rows, std::size_t column) {
  std::size_t falls = 0;
  std::optional<double> before;
  for (const TextTable::Row* row : rows) {
    const auto number =
        row ? files::number_in<double>(TextTable::field(*row, column)) : std::nullopt;
    falls += before && number && *number <= *before;
    if (number) before = number;
  }
  return before && 10 * falls <= rows.size();
}

/// \param names the column of names or numbers, if there is one.
std::size_t time_column(const TextTable& table, std::optional<std::size_t> names,
                        const RowOfFrame& rows) {
  const std::size_t columns = table.rows.front().fields.size();
  if (const auto named = table.time_column()) return *named;
  const bool has_header = !table.header.empty() && !table.is_comment;
  for (std::size_t i = 0; i < columns && !has_header; ++i) {
    const bool is_number =
        files::number_in<double>(TextTable::field(table.rows.front(), i)).has_value();
    if (columns == 1 && is_number && (!is_count(table, i) || increases(rows, i))) return i;
    if (i != names && is_number && !is_count(table, i) && increases(rows, i)) return i;
  }
  if (names && !has_header && increases(rows, *names)) return *names;  // names that are times
  throw input::Error({table.file.string(), table.rows.front().line},
                     "no column holds times that increase: {}; give a time for each picture, in a "
                     "column called time [s], [ms], [us] or [ns]",
                     table.columns());
}

}  // namespace

void time_by_table(const fs::path& file, const std::string& time_unit, Recorded& recorded) {
  const TextTable table = read_table(file);
  if (table.rows.empty()) {
    throw input::Error({file.string(), 0}, "holds no time; give one for each picture");
  }
  RowOfFrame rows;
  std::optional<std::size_t> names;
  for (std::size_t i = 0; i < table.rows.front().fields.size() && rows.empty(); ++i) {
    rows = rows_by_name(table, i, recorded.frames);
    if (!rows.empty()) names = i;
  }
  const std::size_t pictures = recorded.frames.size();
  if (!names) {
    for (const std::size_t row : take_rows(file, table.rows.size(), "time", recorded)) {
      rows.push_back(&table.rows[row]);
    }
  }
  if (rows.size() < pictures) {
    throw input::Error({file.string(), 0},
                       "has {} times for {} pictures, and does not name them; give one for each "
                       "picture, or a column with the names of the pictures",
                       table.rows.size(), pictures);
  }
  const std::size_t column = time_column(table, names, rows);
  const std::int64_t unit_ns = time_unit_of(
      table, column, time_unit, {kSlowestCamera_hz, kFastestCamera_hz, {}}, {}, recorded.tally);
  std::vector<RecordedFrame> timed;
  for (std::size_t i = 0; i < recorded.frames.size(); ++i) {
    RecordedFrame& frame = recorded.frames[i];
    const TextTable::Row* row = rows[i];
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
