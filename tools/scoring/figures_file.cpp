#include "tools/scoring/figures_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/files/json_node.h"
#include "tools/scoring/stages.h"

namespace lcs::bench {
namespace {

/// A row of named columns, so that header and values always match.
class Row {
 public:
  template <class Number>
  Row& operator()(const std::string& name, Number value) {
    return add(name, fmt::format("{}", value));
  }
  Row& operator()(const std::string& name, std::optional<double> value) {
    return add(name, value ? fmt::format("{}", *value) : "");  // shortest exact form
  }
  const std::string& header() const { return header_; }
  const std::string& values() const { return values_; }

 private:
  Row& add(const std::string& name, const std::string& value) {
    const char* separator = header_.empty() ? "" : ",";
    header_ += separator;
    header_ += name;
    values_ += separator;
    values_ += value;
    return *this;
  }
  std::string header_, values_;
};

/// \param rebels absent: the truth is unknown.
Row row_of(const FrameRecord& frame, const std::optional<RebelCounts>& rebels, bool layered) {
  const Layers& layers = frame.layers;
  Row row;
  row("frame", frame.index)("t_s", static_cast<double>(frame.t_ns) * 1e-9);
  row("corners", frame.corners_px.size());
  row("ignored_corners", std::ranges::count(frame.verdicts, Verdict::ignored));
  row("psi", layers.ignored.size())("lambda", layers.collectors.size());
  row("alpha", layers.chains.size());
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
  constexpr input::FileKind kMetricsDocument{kMostJsonBytes, "run the scenario again"};
  return read_json(path, kMetricsDocument, [](const JsonNode& node) {
    Metrics metrics;
    node.each_entry([&](const std::string& name, const JsonNode& figure) {
      metrics.emplace_back(name, figure.figure());
    });
    return metrics;
  });
}

FramesWriter::FramesWriter(const std::filesystem::path& path, const RunInfo& run)
    : file_(path), is_layered_(run.detector.layered), is_truth_known_(run.truth != Truth::unknown) {
  file_.write(row_of(FrameRecord{}, RebelCounts{}, is_layered_).header() + '\n');
}

void FramesWriter::write(const FrameRecord& frame, const RebelCounts& rebels) {
  const auto counts = is_truth_known_ ? std::optional(rebels) : std::nullopt;
  file_.write(row_of(frame, counts, is_layered_).values() + '\n');
}

}  // namespace lcs::bench
