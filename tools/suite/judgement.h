/// \file
/// The judged criteria of a suite, one by one as junit.xml lists them, and the counts of a suite.
/// The console, the report and junit.xml take all their counts from here.
///
/// A criterion counts once for each seed, or once if it is over seeds. A run without criteria
/// counts as one criterion, `runs`: that it ends without an error. So does a run that ends with an
/// error.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

enum class Judged {
  met,
  failed,  ///< required, and not met
  missed,  ///< not required, and not met
  error,   ///< its run ended with an error
};

struct Judgement {
  std::string scenario;  ///< its name
  std::filesystem::path file;
  /// Without the bound, so that it keeps its history when the bound changes: such as "klt: rebel.f1
  /// max, seed 1", without a detector for the suite's own.
  std::string name;
  Judged judged = Judged::met;
  std::string message = {};  ///< empty if met
  std::string anchor;        ///< of its scenario and seed in the report (`anchor_of`)
  /// An equal share of the time of its run, or of all runs of the scenario. The process of a run
  /// has the detectors of `--beside` too, whose criteria have no time.
  double time_s = 0;
  bool is_of_criterion = false;  ///< false for `runs`
};

/// In the order of scenarios and seeds; criteria over seeds come last in their scenario.
/// \param others the results of the detectors of `--beside`, of the same runs.
std::vector<Judgement> judgements_of(const SuiteResult& suite,
                                     std::span<const SuiteResult> others = {});

/// \name Of the suite's own detector and of those beside it.
///@{
struct CriteriaCounts {
  int met = 0, failed = 0, missed = 0, errors = 0;
  bool has_criteria = false;  ///< other than `runs`

  int all() const { return met + failed + missed + errors; }
  int unmet() const { return failed + errors; }  ///< required, and not met
};
CriteriaCounts count_criteria(const std::vector<Judgement>& judgements);
///@}

/// Such as "28 of 33 criteria met, 5 failed"; without criteria "60 runs without an error, no
/// criteria asked for".
std::string text_of(const CriteriaCounts& counts);

/// The runs of the suite's own detector, such as "15 runs of 5 scenarios: 11 passed, 4 failed".
std::string run_counts(const SuiteResult& suite);

/// "1 run", "2 runs".
std::string counted(std::int64_t count, const std::string& noun);

/// A relative address (RFC 3986) of a file beside a page: all other bytes are escaped, and the
/// colon, so that no name becomes a scheme as in "javascript:".
std::string address_of(std::string_view path);

/// The fragment of a report's address, after the #, of a scenario or of its run with a seed.
std::string anchor_of(const std::string& scenario);
std::string anchor_of(const std::string& scenario, std::uint64_t seed);

}  // namespace lcs::suite
