/// \file
/// The table of all metrics: formula, unit, better direction, least change that matters, label and
/// description. Terminal tables, pages, comparisons and SCORING.md use it.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::scoring {

struct Scores;

enum class Direction {
  higher,   ///< higher is better
  lower,    ///< lower is better
  neutral,  ///< neither: truths, sizes of reference stores, times, warnings
};

struct Scale {
  std::string_view unit;  ///< empty for shares (0 to 1), other ratios and counts
  Direction better = Direction::neutral;
  /// A change matters if it exceeds both limits.
  double least_change = 0;  ///< in the unit
  double least_share = 0;   ///< of the value before
  int decimals = 0;         ///< decimals in tables
};

/// A table with some of the metrics, in the order of `metrics()`.
enum class Table {
  suite,      ///< of scenarios: in the terminal, in comparisons and in Python
  report,     ///< report.html
  worlds,     ///< worlds.html
  detectors,  ///< means of several detectors
};

struct Metric {
  std::string key;  ///< as in metrics.json
  std::function<std::optional<double>(const Scores&)> compute;
  Scale scale;
  std::string label;                  ///< column heading or prefix of the value; empty: in no table
  std::string meaning;                ///< its first sentence is the table's legend
  std::span<const Table> shown = {};  ///< the tables with this metric
  recording::Truth needs = recording::Truth::unknown;  ///< undefined if less of the truth is known

  std::string number(std::optional<double> value) const;  ///< without the unit; "-" if undefined
  std::string heading() const;                            ///< such as "latency (frames)"
  std::string_view first_sentence() const;                ///< of the meaning
  /// The key and the whole meaning.
  std::string tooltip() const { return key + ": " + meaning; }
  /// Whether it differs from run to run.
  bool is_time() const { return key.starts_with("time.") || key.starts_with("sim."); }
};

/// `dimension.mean` / `dimension.five_frame_mean`. Only suites have it (`suite::figure_of`), not
/// metrics.json: its `compute` is empty.
inline constexpr std::string_view kSizeShare = "size_share";
inline constexpr std::string_view kF1 = "rebel.f1";
/// The few figures that the verdict on two suites rests on.
inline constexpr std::array<std::string_view, 4> kMainFigures{
    kF1, "rebel.false_corners_per_frame", "rebel.false_objects_per_100_frames", "square.recall_50"};

/// All metrics in the order of metrics.json, then `kSizeShare`.
const std::vector<Metric>& metrics();

/// The keys of a table's metrics.
std::vector<std::string_view> keys_in(Table table);

/// \throws std::out_of_range for an unknown key.
const Metric& metric(std::string_view key);

/// The least change from `before` that matters, in the metric's unit.
double least_change(const Scale& scale, double before);

/// The sign of a change from `before` to `after`: better (> 0), worse (< 0) or neither (0).
int sign_of_change(Direction better, double before, double after);

}  // namespace lcs::scoring
