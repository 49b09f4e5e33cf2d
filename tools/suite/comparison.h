/// \file
/// What two suites differ in beyond the noise of their seeds. How a change is told from noise is
/// explained in `tools/suite/README.md`. The one rule for change: `lcs compare`, `lcs suite
/// --baseline` and the report ask here.
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

enum class Change { improved, regressed, moved, none };  ///< moved: of a neutral figure

struct Difference {
  std::string scenario;  ///< or the group
  std::string metric;
  bench::Direction better = bench::Direction::neutral;
  double before = 0, after = 0;  ///< means over the seeds that both sides have
  Interval change;  ///< of after - before, paired by seed; of a group of worlds by world
  int seeds = 0;    ///< pairs, >= 1
  Change verdict = Change::none;
  /// How many times the least change that matters is certain; above 1 where the change is real.
  double weight = 0;
};

struct Comparison {
  std::vector<Difference> differences;  ///< every figure that was compared, `none` included
  std::vector<Difference> groups;       ///< likewise of the means over the scenarios of each group
  /// What could not be compared, in words: scenarios and seeds of one side alone, figures undefined
  /// on one side, runs without figures on one side.
  std::vector<std::string> incomparable;
  std::vector<std::string> scenarios;  ///< that both sides have
  int judged = 0;                      ///< differences whose figure is not neutral
  bool single_seeds = false;           ///< some difference rests on one seed
  /// Scenarios of which a run that had figures before has none now: whatever the others say, that
  /// is a regression.
  std::set<std::string> lost;

  int count(Change verdict) const;  ///< of `differences`
  std::string note() const;         ///< of single seeds, where there are such; else empty

  /// Regressed where one figure is or a run was lost; else improved where one figure is; else none.
  /// Nothing for a scenario of which no figure could be compared.
  std::optional<Change> of_scenario(const std::string& name) const;
  bool has_regressed() const;
};

/// \param is_wanted which figures. All those of `bench::metrics` but times are compared.
Comparison compare(const SuiteResult& before, const SuiteResult& after,
                   const std::function<bool(std::string_view metric)>& is_wanted);

/// As a person reads it: what regressed, what improved, what could not be compared, how many
/// figures were judged.
/// \param all also what did not change, and figures of which neither way is better.
std::string text_of(const Comparison& comparison, bool all);

/// "0.861 -> 0.612 [-0.270, -0.228]": with the interval of the change, if that is known.
std::string change_text(const Difference& difference);

}  // namespace lcs::suite
