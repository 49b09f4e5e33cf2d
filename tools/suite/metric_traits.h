/// \file
/// Which way each figure of a run is better, and what change of it is worth a word. The one home of
/// both: comparisons and pages ask here.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace lcs::suite {

/// `dimension.mean` over `dimension.five_frame_mean`: the size of all layers beside that of a store
/// of the last five frames' corners. A figure of `figure_of`, not of metrics.json.
inline constexpr std::string_view kSizeShare = "size_share";

enum class Direction {
  higher,   ///< is better
  lower,    ///< is better
  neutral,  ///< neither: what the run was given, how long the filter's yardsticks are, times
};

struct MetricTraits {
  std::string_view name;  ///< as in metrics.json
  Direction direction = Direction::neutral;
  /// A change is too small to matter below the greater of the two.
  double least_change = 0;  ///< in the figure's own unit
  double least_share = 0;   ///< of the figure before
};

/// Every figure of a run, in the order of `bench::score`.
const std::vector<MetricTraits>& metric_traits();

/// `kSizeShare` is known too. Neutral for a figure that is not known, as one of a later version.
MetricTraits traits_of(std::string_view metric);

/// What `metric` may change by from `before` without anybody caring.
double least_change(const MetricTraits& traits, double before);

/// Whether going from `before` to `after` is for the better (> 0), for the worse (< 0) or neither.
int sign_of_change(Direction direction, double before, double after);

}  // namespace lcs::suite
