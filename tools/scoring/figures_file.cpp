#include "tools/scoring/figures_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "tools/files/csv.h"
#include "tools/files/json_node.h"
#include "tools/scoring/scores.h"

namespace lcs::scoring {
namespace {

/// A row of named columns, so that header and values always match.
struct Row {
  std::vector<std::string> header, values;

  template <class Value>
  Row& operator()(const std::string& name, const Value& value) {
    header.push_back(name);
    values.push_back(fmt::format("{}", value));
    return *this;
  }
  Row& operator()(const std::string& name, std::optional<double> value) {
    return (*this)(name, value ? fmt::format("{}", *value) : "");  // shortest exact form
  }
};

std::string line_of(const std::vector<std::string>& cells) {
  return fmt::format("{}\n", fmt::join(cells, ","));
}

/// \param rebels absent: the truth is unknown.
Row row_of(const recording::FrameRecord& frame, const std::optional<RebelCounts>& rebels,
           bool layered) {
  const Layers& layers = frame.layers;
  Row row;
  row("frame", frame.index)("t_s", static_cast<double>(frame.t_ns) * 1e-9);
  row("corners", frame.corners_px.size());
  row("ignored_corners", std::ranges::count(frame.verdicts, Verdict::ignored));
  row("psi", frame.paper.ignored.size())("lambda", frame.paper.collectors.size());
  row("alpha", frame.paper.chains.size());
  row("normal_edges", layers.normal_edges.size())("rebel_edges", layers.rebel_edges.size());
  row("normal_circles", layers.normal_circles.size());
  row("rebel_circles", layers.rebel_circles.size());
  row("squares", layers.squares.size());
  row("dimension", layered ? std::optional<double>(layers.dimension()) : std::nullopt);
  const auto count = [&](int RebelCounts::*number) {
    return rebels ? std::optional<double>((*rebels).*number) : std::nullopt;
  };
  row("true_rebels", count(&RebelCounts::true_rebels));
  row("false_rebels", count(&RebelCounts::false_rebels));
  row("found_rebels", count(&RebelCounts::found_rebels));
  row("missed_rebels", count(&RebelCounts::missed_rebels));
  row("precision", rebels ? rebels->precision() : std::nullopt);
  row("recall", rebels ? rebels->recall() : std::nullopt);
  for (const Stage& stage : kStages) {
    const double ms = frame.times ? (*frame.times).*stage.time_ms : 0;
    const bool is_known = ms > 0 && (layered || !stage.is_layer);
    row(stage.column(), is_known ? std::optional(ms) : std::nullopt);
  }
  return row;
}

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
std::optional<recording::FrameTimes> times_in(const std::vector<std::string_view>& header,
                                              const std::vector<std::string_view>& row) {
  recording::FrameTimes times;
  bool any = false;
  for (const Stage& stage : kStages) {
    const std::string name = stage.column();
    if (stage.is_younger && place_of(header, name) == header.size()) continue;
    const std::string_view text = row[column_of(header, name)];
    if (text.empty()) continue;
    const std::optional<double> ms = files::number_in<double>(text);
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

void write_metrics(const std::filesystem::path& path, const Metrics& metrics) {
  std::string text = "{";
  for (const auto& [name, figure] : metrics) {
    if (text.back() != '{') text += ',';
    text += fmt::format("\n  \"{}\": {}", name, figure ? fmt::format("{}", *figure) : "null");
  }
  files::write_file(path, text + "\n}\n");
}

Metrics read_metrics(const std::filesystem::path& path) {
  constexpr input::FileKind kMetricsDocument{files::kMostJsonBytes, "run the scenario again"};
  return files::read_json(path, kMetricsDocument, [](const files::JsonNode& node) {
    Metrics metrics;
    node.each_entry([&](const std::string& name, const files::JsonNode& figure) {
      metrics.emplace_back(name, figure.figure());
    });
    return metrics;
  });
}

FramesWriter::FramesWriter(const std::filesystem::path& path, const recording::RunInfo& run)
    : file_(path),
      is_layered_(run.detector.layered),
      is_truth_known_(run.truth != recording::Truth::unknown) {
  file_.write(line_of(row_of(recording::FrameRecord{}, RebelCounts{}, is_layered_).header));
}

void FramesWriter::write(const recording::FrameRecord& frame, const RebelCounts& rebels) {
  const auto counts = is_truth_known_ ? std::optional(rebels) : std::nullopt;
  file_.write(line_of(row_of(frame, counts, is_layered_).values));
}

TimesReader::TimesReader(const std::filesystem::path& frames_csv)
    : file_(frames_csv, kFramesTable) {
  file_.next_line(header_line_);
  header_ = files::fields_of(header_line_);
  if (place_of(header_, "frame") == header_.size()) fail("has no column frame");
}

void TimesReader::fail(const std::string& what) const {
  throw input::Error({file_.here().file, line_}, "{}; {}", what, kFramesTable.remedy);
}

void TimesReader::read(recording::FrameRecord& frame) {
  std::string line;
  ++line_;
  if (!file_.next_line(line)) fail(fmt::format("the row of frame {} is missing", frame.index));
  try {
    const std::vector<std::string_view> row = files::fields_of(line);
    if (row.size() != header_.size()) {
      throw std::runtime_error(
          fmt::format("has {} fields, the header {}", row.size(), header_.size()));
    }
    const std::string_view number = row[column_of(header_, "frame")];
    if (files::number_in<int>(number) != frame.index) {
      throw std::runtime_error(
          fmt::format("is of frame '{}', and should be of {}", number, frame.index));
    }
    frame.times = times_in(header_, row);
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
}

void TimesReader::finish() {
  std::string line;
  ++line_;
  if (file_.next_line(line)) fail("there are more rows than the recording has frames");
}

}  // namespace lcs::scoring
