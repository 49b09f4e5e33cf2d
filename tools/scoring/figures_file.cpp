#include "tools/scoring/figures_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/json_node.h"

namespace lcs::bench {
namespace {

/// A row by the names of its columns, so that header and values cannot part.
class Row {
 public:
  template <class Number>
  Row& operator()(const char* name, Number value) {
    return add(name, fmt::format("{}", value));
  }
  Row& operator()(const char* name, std::optional<double> value) {
    return add(name, value ? fmt::format("{}", *value) : "");  // shortest that reads back alike
  }
  const std::string& header() const { return header_; }
  const std::string& values() const { return values_; }

 private:
  Row& add(const char* name, const std::string& value) {
    const char* separator = header_.empty() ? "" : ",";
    header_ += separator;
    header_ += name;
    values_ += separator;
    values_ += value;
    return *this;
  }
  std::string header_, values_;
};

Row row_of(const FrameRecord& frame, const RebelCounts& rebels, bool layered) {
  const auto time = [&](double FrameTimes::*stage) -> std::optional<double> {
    return frame.times && (*frame.times).*stage > 0 ? std::optional((*frame.times).*stage)
                                                    : std::nullopt;
  };
  const auto stage_time = [&](double FrameTimes::*stage) {
    return layered ? time(stage) : std::nullopt;
  };
  const Layers& layers = frame.layers;
  Row row;
  row("frame", frame.index)("t_s", static_cast<double>(frame.t_ns) * 1e-9);
  row("corners", frame.corners_px.size());
  row("ignored_corners",
      std::count(frame.verdicts.begin(), frame.verdicts.end(), Verdict::ignored));
  row("psi", layers.ignored.size())("lambda", layers.collectors.size());
  row("alpha", layers.chains.size());
  row("normal_edges", layers.normal_edges.size())("rebel_edges", layers.rebel_edges.size());
  row("normal_circles", layers.normal_circles.size());
  row("rebel_circles", layers.rebel_circles.size());
  row("squares", layers.squares.size());
  row("dimension", layered ? std::optional<double>(layers.dimension()) : std::nullopt);
  row("true_rebels", rebels.true_rebels)("false_rebels", rebels.false_rebels);
  row("found_rebels", rebels.found_rebels)("missed_rebels", rebels.missed_rebels);
  row("precision", rebels.precision())("recall", rebels.recall());
  row("detect_ms", time(&FrameTimes::detect_ms));
  row("describe_ms", time(&FrameTimes::describe_ms))("line_ms", stage_time(&FrameTimes::line_ms));
  row("circle_ms", stage_time(&FrameTimes::circle_ms));
  row("square_ms", stage_time(&FrameTimes::square_ms));
  row("filter_ms", time(&FrameTimes::filter_ms))("process_ms", time(&FrameTimes::process_ms));
  row("simulate_ms", time(&FrameTimes::simulate_ms));
  row("truth_ms", time(&FrameTimes::truth_ms));
  return row;
}

}  // namespace

void write_metrics(const std::filesystem::path& path, const Metrics& metrics) {
  std::string text = "{";
  for (const auto& [name, figure] : metrics) {
    if (text.back() != '{') text += ',';
    text += fmt::format("\n  \"{}\": {}", name, figure ? fmt::format("{}", *figure) : "null");
  }
  write_file(path, text + "\n}\n");
}

Metrics read_metrics(const std::filesystem::path& path) {
  constexpr scenario::FileKind kMetricsDocument{kMostJsonBytes, "run the scenario again"};
  return read_json(path, kMetricsDocument, [](const JsonNode& node) {
    Metrics metrics;
    node.each_entry([&](const std::string& name, const JsonNode& figure) {
      metrics.emplace_back(name, figure.figure());
    });
    return metrics;
  });
}

void write_frames(const std::filesystem::path& path, const Recording& recording) {
  const std::vector<RebelCounts> rebels = score_frames(recording);
  const bool layered = recording.detector.layered;
  OutputFile file(path);
  file.write(row_of(FrameRecord{}, RebelCounts{}, layered).header() + '\n');
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    file.write(row_of(recording.frames[i], rebels[i], layered).values() + '\n');
  }
  file.close();
}

}  // namespace lcs::bench
