/// \file
/// The search for the filter's learnt numbers: NLopt's BOBYQA (Powell, "The BOBYQA Algorithm for
/// Bound Constrained Optimization without Derivatives", 2009) on the logarithm of each. It fits a
/// quadratic to what it has seen, for which twice as many evaluations do as there are numbers.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "filter/parameters.h"
#include "tools/tune/journal.h"
#include "tools/tune/trials.h"

namespace lcs::tune {

/// A parameter, and its value as `set` takes it.
struct Setting {
  std::string key, value;
};

/// A number that is looked for, and where: between a quarter and four times its present value, and
/// within its range.
struct Axis {
  std::string key;
  double start = 0, low = 0, high = 0;
};

/// \throws std::invalid_argument for a key that is unknown, is given twice, or is of no number
/// above
///   0.
std::vector<Axis> axes_of(const Parameters& start, const std::vector<std::string>& keys);

struct SearchOptions {
  std::vector<Axis> axes;
  int evaluations = 0;  ///< at the most; those of an earlier search that it resumes too
  /// 1 starts from the present values, any other from a point that it draws about them, so that the
  /// same end from several says that it is one.
  std::uint64_t seed = 1;
};

struct Found {
  std::vector<Setting> before, after;  ///< by key; the latter are the best that were tried
  Worth worth_before, worth_after;
  int evaluations = 0;
};

using Judge = std::function<Worth(const Parameters&)>;

/// What the search itself depends on, for its journal.
std::vector<Fact> facts_of(const SearchOptions& options);

/// \param journal that each evaluation is added to as it is made. What it holds already is not
/// asked
///   again, so that a search that was interrupted goes on where it was: it is the same in each run.
/// \param tick called after each evaluation with their number; what it throws ends the search.
/// \throws bench::OutputError
Found search(const Parameters& start, const SearchOptions& options, const Judge& judge,
             Journal& journal, const std::function<void(int)>& tick);

}  // namespace lcs::tune
