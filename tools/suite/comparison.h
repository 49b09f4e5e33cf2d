/// \file
/// Differences between two suites beyond the noise of their seeds. `tools/suite/README.md` explains
/// how a change is distinguished from noise. `lcs compare`, `lcs suite --baseline` and the report
/// all use this rule.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scoring/metrics.h"
#include "tools/suite/interval.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

enum class Change { improved, regressed, moved, none };  ///< moved: a neutral figure changed

struct Difference {
  std::string scenario;  ///< name of the scenario or group
  std::string metric;
  bench::Direction better = bench::Direction::neutral;
  double before = 0, after = 0;  ///< means over the seeds that both sides have
  Interval change;  ///< of after - before, paired by seed; for a group of worlds by world
  int seeds = 0;    ///< number of pairs, >= 1
  Change verdict = Change::none;
  /// (|mean| - half) of the change, over the least change that matters; above 1 if real.
  double weight = 0;
};

struct Comparison {
  std::vector<Difference> differences;  ///< all compared figures, also unchanged ones
  std::vector<Difference> groups;       ///< likewise for the means over each group
  /// Messages on data of only one side: scenarios, seeds, figures that the other side leaves
  /// undefined, runs that have no figures on the other side.
  std::vector<std::string> incomparable;
  std::vector<std::string> scenarios;  ///< names of those on both sides
  int judged = 0;                      ///< number of differences of figures that are not neutral
  bool single_seeds = false;           ///< whether a difference rests on one seed
  /// Scenarios with a run that had figures before and has none now. Each counts as a regression,
  /// whatever its other figures are.
  std::set<std::string> lost;

  int count(Change verdict) const;  ///< in `differences`
  std::string note() const;         ///< a caveat if `single_seeds`, else empty

  /// Regressed if a figure is or a run is lost; else improved if a figure is; else none.
  /// Absent for a scenario without any compared figure.
  std::optional<Change> of_scenario(const std::string& name) const;
  bool has_regressed() const;
};

/// Compares the metrics for which `is_wanted` is true. Times are never compared.
Comparison compare(const SuiteResult& before, const SuiteResult& after,
                   const std::function<bool(std::string_view metric)>& is_wanted);

/// A report for the user: the regressions, the improvements, the data that could not be compared,
/// and the number of judged figures.
/// \param all also unchanged figures and figures that are neutral.
std::string text_of(const Comparison& comparison, bool all);

/// Such as "0.861 -> 0.612 [-0.270, -0.228]", with the interval of the change if it is known.
std::string change_text(const Difference& difference);

}  // namespace lcs::suite
