/// \file
/// The search for the filter's learnt numbers: NLopt's BOBYQA (Powell, "The BOBYQA Algorithm for
/// Bound Constrained Optimization without Derivatives", 2009) on the logarithm of each. It fits a
/// quadratic to what it has seen, for which twice as many evaluations do as there are numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "filter/parameters.h"
#include "tools/tune/trials.h"

namespace lcs::tune {

/// A parameter, and its value as `set` takes it.
struct Setting {
  std::string key, value;
};

struct SearchOptions {
  std::vector<std::string> keys;  ///< of parameters that are numbers above 0
  int evaluations = 0;            ///< at the most; those of an earlier search that it resumes too
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

/// Tries values between a quarter and four times the present ones, within their range.
///
/// \param journal CSV that each evaluation is added to as it is made. Where there is one of the
///   same search, what it holds is not asked again, so that a search that was interrupted goes on
///   where it was: it is the same in each run.
/// \param subject what the journal is of, beside the keys and their values: a line of text.
/// \param tick called after each evaluation with their number; what it throws ends the search.
/// \throws std::invalid_argument for a key that is no number above 0; std::runtime_error for a
///   journal of another search; bench::OutputError.
Found search(const Parameters& start, const SearchOptions& options, const Judge& judge,
             const std::filesystem::path& journal, const std::string& subject,
             const std::function<void(int)>& tick);

}  // namespace lcs::tune
