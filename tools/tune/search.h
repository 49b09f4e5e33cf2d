/// \file
/// The search for the filter's learnt parameters: NLopt's BOBYQA (Powell, "The BOBYQA Algorithm for
/// Bound Constrained Optimization without Derivatives", 2009) on the logarithm of each. It fits a
/// quadratic model, which takes about twice as many evaluations as there are parameters.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "filter/parameters.h"
#include "tools/tune/evaluations.h"
#include "tools/tune/trials.h"

namespace lcs::tune {

/// A parameter's key and its value in the form that `set` accepts.
struct Setting {
  std::string key, value;
};

/// A searched parameter and its bounds: a quarter to four times its present value, within its
/// range.
struct Axis {
  std::string key;
  double start = 0, low = 0, high = 0;
};

/// \throws std::invalid_argument for a key that is unknown or given twice, or whose value is not a
///   number above 0.
std::vector<Axis> axes_of(const Parameters& start, const std::vector<std::string>& keys);

struct SearchOptions {
  std::vector<Axis> axes;
  int evaluations = 0;  ///< at most, including evaluations of the search that it resumes
  /// 1 starts from the present values; any other seed from a random point near them. Equal results
  /// from several starts indicate a true optimum.
  std::uint64_t seed = 1;
};

struct Found {
  std::vector<Setting> before, after;  ///< by key; `after` has the best ones found
  Worth worth_before, worth_after;
  int evaluations = 0;
};

using Judge = std::function<Worth(const Parameters&)>;

/// Adds the facts about the search itself to the facts of a provenance.
void add_facts(files::Json& facts, const SearchOptions& options);

/// \param known receives each evaluation. Evaluations that it already holds are not repeated.
///   The search is deterministic, so an interrupted search resumes at the same point.
/// \param tick called after each evaluation with the number so far; an exception ends the search.
/// \throws files::OutputError
Found search(const Parameters& start, const SearchOptions& options, const Judge& judge,
             Evaluations& known, const std::function<void(int)>& tick);

}  // namespace lcs::tune
