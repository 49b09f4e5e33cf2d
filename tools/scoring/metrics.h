/// \file
/// The table of all metrics: how each is computed, its unit, which way is better, which change
/// matters, and its words for people. Consoles, pages, comparisons and SCORING.md read it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::bench {

struct Scores;

enum class Direction {
  higher,   ///< is better
  lower,    ///< is better
  neutral,  ///< neither: truths, sizes of stores that are compared with, times, warnings
};

struct Scale {
  std::string_view unit;  ///< empty for shares (0 to 1), other ratios and counts
  Direction better = Direction::neutral;
  /// A change matters if it is greater than both.
  double least_change = 0;  ///< in the unit
  double least_share = 0;   ///< of the value before
  int decimals = 0;         ///< that tables show
};

struct Metric {
  std::string key;  ///< as in metrics.json
  std::function<std::optional<double>(const Scores&)> compute;
  Scale scale;
  std::string label;             ///< heads a column, or stands before the value; empty: in no table
  std::string meaning;           ///< the first sentence alone suffices below a table
  Truth needs = Truth::unknown;  ///< undefined if less of the truth is known

  std::string number(std::optional<double> value) const;  ///< without the unit; "-": undefined
  std::string heading() const;                            ///< "latency (frames)"
  std::string tooltip() const;                            ///< the key and the whole meaning
  std::string_view first_sentence() const;                ///< of the meaning
  bool is_time() const;                                   ///< differs from run to run
};

/// `dimension.mean` over `dimension.five_frame_mean`. Suites have it (`suite::figure_of`), while
/// metrics.json does not: its `compute` is empty.
inline constexpr std::string_view kSizeShare = "size_share";

/// In the order of metrics.json; the last is `kSizeShare`.
const std::vector<Metric>& metrics();

/// \throws std::out_of_range for an unknown key.
const Metric& metric(std::string_view key);

/// The least change from `before` that matters.
double least_change(const Scale& scale, double before);

/// Whether a change from `before` to `after` is for the better (> 0), for the worse (< 0) or
/// neither.
int sign_of_change(Direction better, double before, double after);

}  // namespace lcs::bench
