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
#include "tools/scoring/table.h"
#include "tools/suite/interval.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

enum class Change {
  improved,
  regressed,
  moved,  ///< a neutral figure changed
  none,
  unknown,  ///< it changed by more than matters, in a single pair, whose noise is unknown
};

/// The word for the user, such as "regressed".
const char* word_of(Change change);

/// What a comparison has shown, by the main figures (`scoring::kMainFigures`).
enum class Finding {
  regressed,   ///< the mean of a main figure regressed, or a run has lost its figures
  not_judged,  ///< no main figure is compared, or runs of the earlier suite are missing
  uncertain,   ///< none regressed, but a loss that matters is not excluded, or another figure, a
               ///< scenario or a criterion failed
  equal,       ///< the main figures have lost less than matters
};

/// The word for the user, such as "no regression found".
const char* word_of(Finding finding);

struct Difference {
  std::string scenario;  ///< name of the scenario or group
  std::string metric;
  scoring::Direction better = scoring::Direction::neutral;
  double before = 0, after = 0;  ///< means over the seeds that both sides have
  Interval change;  ///< of after - before, paired by seed; for a group of worlds by world
  int pairs = 0;    ///< of runs; for a group of scenarios or worlds, >= 1
  Change verdict = Change::none;
  /// (|mean| - half) of the change, over the least change that matters; above 1 if real.
  double weight = 0;
  bool is_main = false;  ///< whether the finding rests on it

  /// The word of a verdict that is a regression or an improvement; else "".
  const char* real_word() const;

  /// The worse end of the interval of the change, >= 0; infinite if a change has an unknown noise.
  double possible_loss() const;
  /// The mean of the change, positive if it is a loss.
  double loss() const;
  /// A loss up to this one counts as none: twice the least change that matters.
  double margin() const;
};

struct Comparison {
  std::vector<Difference> differences;  ///< all compared figures, also unchanged ones
  /// Likewise for the means over each group, and over all scenarios if no group has them all. Main
  /// ones are those of `scoring::kMainFigures` over the largest group, or if none of these figures
  /// is wanted, of all. The verdicts of the main ones hold together, and so do those of the others:
  /// at most one in twenty comparisons of equals has any that is real.
  std::vector<Difference> groups;
  /// Messages on data of only one side: scenarios, seeds, figures that the other side leaves
  /// undefined, runs that have no figures on the other side.
  std::vector<std::string> incomparable;
  std::vector<std::string> scenarios;  ///< names of those on both sides
  /// Messages on runs of the earlier suite that the later one lacks, or has with another number of
  /// frames.
  std::vector<std::string> missing;
  int undefined = 0;  ///< main figures of single scenarios that only the earlier suite defines
  bool is_of_worlds = false;    ///< the intervals of `groups` are over worlds, else over seeds
  double level = kFalseAlarms;  ///< of all intervals and verdicts: .05, or of a look (sequential.h)
  int judged = 0;               ///< number of differences of figures that are not neutral
  int judged_means = 0;         ///< likewise of `groups`, those with known noise
  /// Scenarios with a run that had figures before and has none now. Each counts as a regression,
  /// whatever its other figures are.
  std::set<std::string> lost;

  std::vector<const Difference*> with(Change verdict) const;  ///< of `differences`
  int count_means(Change verdict) const;                      ///< in `groups`
  std::string note() const;  ///< the caveats on single scenarios; may be empty

  /// Regressed if a figure is or a run is lost; else unknown, else improved if a figure is; else
  /// none. Absent for a scenario without any compared figure.
  std::optional<Change> of_scenario(const std::string& name) const;
  /// Whether a main mean has regressed or a run is lost.
  bool has_regressed() const;
  /// \param failed_criteria of the later suite, and its runs with an error.
  Finding finding(int failed_criteria) const;
};

/// The finding in words, with its reasons: such as "regressed: rebel.f1 0.861 -> 0.612 [-0.270,
/// -0.228]" or "no regression found, but a loss of up to 0.063 of rebel.f1 is not excluded".
std::string text_of(Finding finding, const Comparison& comparison, int failed_criteria);

/// Compares the metrics for which `is_wanted` is true. Times are never compared. If `after` was
/// stopped early (`SuiteResult::sequential`), only its runs of `before` count.
Comparison compare(const SuiteResult& before, const SuiteResult& after,
                   const std::function<bool(std::string_view metric)>& is_wanted);

/// The means to show: over the largest group the figures of the suite's table, and F1 over every
/// other group; all others only if they have changed.
/// \param all all of them.
std::vector<const Difference*> shown_means(const Comparison& comparison, bool all);

/// `shown_means` with their changes and half the width of their intervals, a row each.
std::string means_text(const Comparison& comparison, bool all,
                       scoring::Format format = scoring::Format::text);

/// A report for the user: the means, and the single scenarios that regressed, improved or changed
/// by unknown noise; as text also the data that could not be compared. \param all also unchanged
/// figures and figures that are neutral.
std::string text_of(const Comparison& comparison, bool all,
                    scoring::Format format = scoring::Format::text);

/// Such as "0.861 -> 0.612 [-0.270, -0.228]", with the interval of the change if it is known.
std::string change_text(const Difference& difference);

}  // namespace lcs::suite
