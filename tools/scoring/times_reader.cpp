#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/stages.h"

namespace lcs::bench {
namespace {

/// The column's index; the number of columns if the header lacks it.
std::size_t place_of(const std::vector<std::string_view>& header, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(header, name) - header.begin());
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

// A frame takes some 200 bytes.
constexpr input::FileKind kFramesTable{
    input::kGibibyte, "run the scenario again, or remove the file to have no times"};

}  // namespace

TimesReader::TimesReader(const std::filesystem::path& frames_csv)
    : file_(frames_csv, kFramesTable) {
  file_.next_line(header_line_);
  header_ = fields_of(header_line_);
  if (place_of(header_, "frame") == header_.size()) fail("has no column frame");
}

void TimesReader::fail(const std::string& what) const {
  throw input::Error({file_.here().file, line_}, "{}; {}", what, kFramesTable.remedy);
}

void TimesReader::read(FrameRecord& frame) {
  std::string line;
  ++line_;
  try {
    if (!file_.next_line(line)) {
      throw std::runtime_error(fmt::format("the row of frame {} is missing", frame.index));
    }
    const std::vector<std::string_view> row = fields_of(line);
    if (row.size() != header_.size()) {
      throw std::runtime_error(
          fmt::format("has {} fields, the header {}", row.size(), header_.size()));
    }
    const std::string_view number = row[column_of(header_, "frame")];
    if (number_in<int>(number) != frame.index) {
      throw std::runtime_error(
          fmt::format("is of frame '{}', and should be of {}", number, frame.index));
    }
    frame.times = times_in(header_, row);
  } catch (const input::Error&) {
    throw;  // it already names the file
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
}

void TimesReader::finish() {
  std::string line;
  ++line_;
  if (file_.next_line(line)) fail("there are more rows than the recording has frames");
}

}  // namespace lcs::bench
