#include "tools/output/table.h"

#include <fmt/format.h>

#include <initializer_list>

#include "tools/scoring/metrics.h"
#include "tools/scoring/score_rebels.h"

namespace lcs::output {
namespace {

/// A unit follows the first of successive figures that share it.
std::string line(std::string_view head, const scoring::Metrics& metrics, bool with_undefined,
                 std::initializer_list<std::string_view> keys) {
  std::string text = fmt::format("  {:<8}", head);
  std::string_view gap = " ", unit;
  for (const std::string_view key : keys) {
    const scoring::Metric& metric = scoring::metric(key);
    const std::optional<double> figure = scoring::value(metrics, metric.key);
    if (!figure && !with_undefined) continue;
    text += fmt::format("{}{} {}", gap, metric.label, metric.number(figure));
    if (figure && metric.scale.unit != unit) text += fmt::format(" {}", metric.scale.unit);
    unit = metric.scale.unit;
    gap = "   ";
  }
  return text + '\n';
}

/// A line that explains the one above it.
std::string remark(std::string_view text) {
  return fmt::format("  {:<8} {}\n", "", text);
}

/// The lines of figures that need a truth.
std::string scores(const scoring::Metrics& metrics) {
  std::string text;
  if (!scoring::value(metrics, scoring::kF1)) {
    text += line("rebels", metrics, true, {"rebel.false_corners_per_frame"});
    text += remark("nothing to find: no corner moves by itself for long enough");
  } else {
    text += line("rebels", metrics, true,
                 {"rebel.precision", "rebel.recall", scoring::kF1, "rebel.f1_clear",
                  "rebel.f1_distinct", "rebel.recall_radial"});
  }
  constexpr double kPoor = 0.7, kMuch = 0.1;
  if (scoring::value(metrics, scoring::kF1).value_or(1) < kPoor) {
    text += line("F1 lost", metrics, true,
                 {"rebel.f1_lost_radial", "rebel.f1_lost_outline", "rebel.f1_lost_first_seen",
                  "rebel.f1_lost_tracked"});
  }
  if (scoring::value(metrics, "rebel.f1_lost_radial").value_or(0) > kMuch) {
    text += remark(
        "radial: along the line of sight, where an image moves as a static point's image may "
        "(filter/MODEL.md#limits)");
  }
  text += line("objects", metrics, true,
               {"truth.rebel_objects", "rebel.object_recall", "rebel.latency_frames_median",
                "rebel.false_objects_per_100_frames"});
  if (scoring::value(metrics, "rebel.object_recall").value_or(0) -
          scoring::value(metrics, "rebel.recall").value_or(0) >
      0.5) {
    text +=
        remark(fmt::format("a mover is found by {} of its corners in one frame; recall counts all "
                           "of its corners in all frames",
                           scoring::kCornersToFind));
  }
  text += line("squares", metrics, true,
               {"square.precision_50", "square.recall_50", "square.recall_50_movers",
                "square.recall_50_static", "square.mean_iou"});
  text += line("movers", metrics, true,
               {"mover.detection_rate", "mover.hota", "mover.j_and_f", "mover.latency_ms_median"});
  return text;
}

}  // namespace

std::string table(const scoring::Metrics& metrics) {
  std::string text;
  if (!scoring::value(metrics, "truth.fixed_corners")) {  // no truth to score against
    text += line("found", metrics, true,
                 {"dimension.corners_mean", "found.rebels_per_frame", "found.movers_per_frame"});
  } else {
    text += scores(metrics);
  }

  if (scoring::value(metrics, "labels.frames")) {
    text += line("labels", metrics, true,
                 {"labels.frames", "labels.boxes", "labels.found", "labels.boxed_50",
                  "labels.rebels_off_per_frame", "labels.circles_off_per_100_frames"});
  }
  const auto size = [&](const char* key) {
    return scoring::metric(key).number(scoring::value(metrics, key));
  };
  text += fmt::format(
      "  size     {} items (edges, circles, squares) are kept; 5 frames have {} corners, 8 have "
      "{}, all {}\n",
      size("dimension.mean"), size("dimension.five_frame_mean"), size("dimension.eight_frame_mean"),
      size("dimension.accumulative_final"));
  text += line("time", metrics, false,
               {"time.filter_ms_median", "time.line_ms_median", "time.circle_ms_median",
                "time.square_ms_median", "time.filter_ms_p99", "time.process_ms_median",
                "time.process_ms_p99", "time.detect_ms_median", "time.describe_ms_median"});
  return text;
}

scoring::FigureTable figure_table(
    const std::vector<std::pair<std::string, scoring::Metrics>>& detectors) {
  scoring::FigureTable table{{{"figure", "figure"}, {"unit", "unit"}}};
  for (const auto& [name, metrics] : detectors) table.columns.push_back({name, name});
  for (const scoring::Metric& metric : scoring::metrics()) {
    if (!metric.compute) continue;  // only suites have it
    std::vector<scoring::Cell> row{metric.key, std::string(metric.scale.unit)};
    bool is_there = false;
    for (const auto& [name, metrics] : detectors) {
      const auto value = scoring::value(metrics, metric.key);
      is_there |= value.has_value();
      scoring::Cell& cell = row.emplace_back();
      if (value) cell = scoring::TableFigure{*value, {}, metric.scale.decimals};
    }
    if (is_there) table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace lcs::output
