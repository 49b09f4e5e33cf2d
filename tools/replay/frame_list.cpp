#include "tools/replay/recorded.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "tools/files/csv.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

/// The row of each frame; null for a frame without one.
using RowOfFrame = std::vector<const TextTable::Row*>;

/// Whether a column holds whole numbers without a gap, in any order.
bool is_count(const TextTable& table, std::size_t column) {
  std::set<long> numbers;
  for (const TextTable::Row& row : table.rows) {
    const auto number = files::number_in<long>(TextTable::field(row, column));
    if (!number || !numbers.insert(*number).second) return false;
  }
  return numbers.size() > 1 && *numbers.rbegin() - *numbers.begin() == std::ssize(numbers) - 1;
}

/// The rows by the names of pictures in a column; empty unless most rows name one, with or without
/// its ending. \throws input::Error if two rows name one picture, in other folders.
RowOfFrame rows_by_name(const TextTable& table, std::size_t column,
                        const std::vector<RecordedFrame>& frames) {
  std::map<std::string, std::size_t> frame_of_stem;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].picture.empty()) frame_of_stem[frames[i].picture.stem().string()] = i;
  }
  RowOfFrame rows(frames.size());
  std::size_t named = 0;
  for (const TextTable::Row& row : table.rows) {
    const fs::path name = TextTable::field(row, column);
    auto found = frame_of_stem.find(name.filename().string());
    if (found == frame_of_stem.end()) found = frame_of_stem.find(name.stem().string());
    if (found == frame_of_stem.end()) continue;
    ++named;
    const RecordedFrame& frame = frames[found->second];
    const TextTable::Row*& other = rows[found->second];
    const auto is_here = [&](const TextTable::Row& of) {
      const std::string whole = fmt::format("/{}", frame.picture.string());
      return whole.ends_with(fmt::format("/{}", TextTable::field(of, column)));
    };
    if (!other || (is_here(row) && !is_here(*other))) {
      other = &row;
    } else if (!is_here(*other) && TextTable::field(*other, column) != name.string()) {
      throw input::Error({table.file.string(), row.line},
                         "{} and {} may both be the picture {}; give the rows of its folder alone",
                         TextTable::field(*other, column), name.string(), frame.name());
    }
  }
  // A count from 0 is not that of the names 1.png, 2.png, ...
  const bool is_partly = is_count(table, column) && std::ranges::count(rows, nullptr) > 0;
  return 2 * named > table.rows.size() && !is_partly ? rows : RowOfFrame{};
}

/// The rows by the numbers of pictures in a column; empty unless it has those of all pictures.
RowOfFrame rows_by_number(const TextTable& table, std::size_t column,
                          const std::vector<RecordedFrame>& frames) {
  std::map<std::size_t, const TextTable::Row*> row_of_number;
  for (const TextTable::Row& row : table.rows) {
    const auto number = files::number_in<std::size_t>(TextTable::field(row, column));
    if (number) row_of_number.emplace(*number, &row);
  }
  RowOfFrame rows;
  for (const RecordedFrame& frame : frames) {
    const auto found = frame.named ? row_of_number.find(*frame.named) : row_of_number.end();
    if (found == row_of_number.end()) return {};
    rows.push_back(found->second);
  }
  return rows;
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

/// The column of times where no header names it. \param names column of names, if there is one.
std::size_t time_column(const TextTable& table, std::optional<std::size_t> names,
                        const RowOfFrame& rows) {
  const std::size_t columns = table.rows.front().fields.size();
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
  for (const auto& rows_by : {rows_by_name, rows_by_number}) {
    for (std::size_t i = 0; i < table.rows.front().fields.size() && rows.empty(); ++i) {
      rows = rows_by(table, i, recorded.frames);
      if (!rows.empty()) names = i;
    }
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
  const TableTimes times{time_unit, {kSlowestCamera_hz, kFastestCamera_hz, {}}, {}};
  TimeColumn time;
  if (table.time_column()) {
    time = time_column_of(table, times, recorded.tally);
  } else {
    time.column = time_column(table, names, rows);
    time.unit_ns = times.unit_ns(table, time.column, recorded.tally);
  }
  std::vector<RecordedFrame> timed;
  for (std::size_t i = 0; i < recorded.frames.size(); ++i) {
    RecordedFrame& frame = recorded.frames[i];
    const TextTable::Row* row = rows[i];
    const auto t_ns = row ? time.of(*row) : std::nullopt;
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
