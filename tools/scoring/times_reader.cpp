#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "tools/files/csv.h"
#include "tools/input/input_file.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/stages.h"

namespace lcs::bench {
namespace {

/// The column's index; the number of columns if the header lacks it.
std::size_t place_of(const std::vector<std::string_view>& header, std::string_view name) {
  return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
}

std::size_t column_of(const std::vector<std::string_view>& header, std::string_view name) {
  const std::size_t place = place_of(header, name);
  if (place == header.size()) throw std::runtime_error(fmt::format("has no column {}", name));
  return place;
}

/// A row's times; absent if every time is empty. An empty time of a single stage counts as 0.
std::optional<FrameTimes> times_in(const std::vector<std::string_view>& header,
                                   const std::vector<std::string_view>& row) {
  FrameTimes times;
  bool any = false;
  for (const Stage& stage : kStages) {
    const std::string name = stage.column();
    if (stage.is_younger && place_of(header, name) == header.size()) continue;
    const std::string_view text = row[column_of(header, name)];
    if (text.empty()) continue;
    const std::optional<double> ms = number_in<double>(text);
    if (!ms) throw std::runtime_error(fmt::format("{} is '{}', not a number", name, text));
    times.*stage.time_ms = *ms;
    any = true;
  }
  return any ? std::optional(times) : std::nullopt;
}

}  // namespace

void read_times(const std::filesystem::path& frames_csv, Recording& recording) {
  // A frame takes some 200 bytes.
  constexpr input::FileKind kFramesTable{
      input::kGibibyte, "run the scenario again, or remove the file to have no times"};
  input::InputFile file(frames_csv, kFramesTable);
  std::string header_line, line;
  file.next_line(header_line);
  const std::vector<std::string_view> header = fields_of(header_line);
  int number = 1;
  try {
    const std::size_t frame_column = column_of(header, "frame");
    for (FrameRecord& frame : recording.frames) {
      ++number;
      if (!file.next_line(line)) {
        throw std::runtime_error(fmt::format("the row of frame {} is missing", frame.index));
      }
      const std::vector<std::string_view> row = fields_of(line);
      if (row.size() != header.size()) {
        throw std::runtime_error(
            fmt::format("has {} fields, the header {}", row.size(), header.size()));
      }
      if (number_in<int>(row[frame_column]) != frame.index) {
        throw std::runtime_error(
            fmt::format("is of frame '{}', and should be of {}", row[frame_column], frame.index));
      }
      frame.times = times_in(header, row);
    }
    ++number;
    if (file.next_line(line)) {
      throw std::runtime_error("there are more rows than the recording has frames");
    }
  } catch (const input::Error&) {
    throw;  // it already names the file
  } catch (const std::runtime_error& error) {
    throw input::Error({frames_csv.string(), number},
                       fmt::format("{}; {}", error.what(), kFramesTable.remedy));
  }
}

}  // namespace lcs::bench
