#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "scenarios/input_file.h"
#include "tools/bench/csv.h"
#include "tools/bench/report.h"

namespace lcs::bench {
namespace {

constexpr std::pair<const char*, double FrameTimes::*> kColumns[] = {
    {"simulate_ms", &FrameTimes::simulate_ms}, {"detect_ms", &FrameTimes::detect_ms},
    {"line_ms", &FrameTimes::line_ms},         {"circle_ms", &FrameTimes::circle_ms},
    {"square_ms", &FrameTimes::square_ms},     {"filter_ms", &FrameTimes::filter_ms},
    {"truth_ms", &FrameTimes::truth_ms}};

std::size_t column_of(const std::vector<std::string_view>& header, std::string_view name) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) throw std::runtime_error(fmt::format("has no column {}", name));
  return static_cast<std::size_t>(found - header.begin());
}

/// None where every time is empty; a stage that the detector does not have is empty, and 0.
std::optional<FrameTimes> times_in(const std::vector<std::string_view>& header,
                                   const std::vector<std::string_view>& row) {
  FrameTimes times;
  bool any = false;
  for (const auto& [name, member] : kColumns) {
    const std::string_view text = row[column_of(header, name)];
    if (text.empty()) continue;
    const std::optional<double> ms = number_in<double>(text);
    if (!ms) throw std::runtime_error(fmt::format("{} is '{}', not a number", name, text));
    times.*member = *ms;
    any = true;
  }
  return any ? std::optional(times) : std::nullopt;
}

}  // namespace

void read_times(const std::filesystem::path& frames_csv, Recording& recording) {
  // Some 200 bytes a frame.
  constexpr scenario::FileKind kFramesTable{
      scenario::kGibibyte, "run the scenario again, or remove the file to have no times"};
  scenario::InputFile file(frames_csv, kFramesTable);
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
  } catch (const scenario::Error&) {
    throw;  // the file itself
  } catch (const std::runtime_error& error) {
    throw scenario::Error({frames_csv.string(), number},
                          fmt::format("{}; {}", error.what(), kFramesTable.remedy));
  }
}

}  // namespace lcs::bench
