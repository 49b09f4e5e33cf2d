/// \file
/// What two suites differ in beyond the noise of their seeds. How a change is told from noise is
/// explained in `tools/suite/README.md`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/suite/interval.h"
#include "tools/suite/metric_traits.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

enum class Change { improved, regressed, moved, none };  ///< moved: of a neutral figure

struct Difference {
  std::string scenario;
  std::string metric;
  Direction direction = Direction::neutral;
  double before = 0, after = 0;  ///< means over the seeds that both sides have
  Interval change;               ///< of after - before, paired by seed
  int seeds = 0;                 ///< pairs, >= 1
  Change verdict = Change::none;
};

struct Comparison {
  std::vector<Difference> differences;  ///< every figure that was compared, `none` included
  /// What could not be compared, in words: scenarios and seeds of one side alone, figures undefined
  /// on one side, runs without figures on one side.
  std::vector<std::string> incomparable;
  int scenarios = 0;          ///< that both sides have
  int judged = 0;             ///< differences whose figure is not neutral
  bool single_seeds = false;  ///< some difference rests on one seed
  /// A run that had figures before has none now: whatever the others say, that is no improvement.
  bool lost_runs = false;

  int count(Change verdict) const;
};

/// \param is_wanted which figures. All those of `metric_traits` but times are compared.
Comparison compare(const SuiteResult& before, const SuiteResult& after,
                   const std::function<bool(std::string_view metric)>& is_wanted);

/// As a person reads it: what regressed, what improved, what could not be compared, counts.
/// \param all also what did not change, and figures of which neither way is better.
std::string text_of(const Comparison& comparison, bool all);

}  // namespace lcs::suite
