/// \file
/// The verdict on a suite: one line, and the worst scenarios with their reasons.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// A suite and the folder that its runs' folders are relative to.
struct SuiteInFolder {
  const SuiteResult& suite;
  std::filesystem::path folder;  ///< "": not to be read

  /// The run's file of events; "" if it has none.
  std::filesystem::path events_of(const RunResult& run) const;
};

/// Worst first. changed: by more than matters, with one seed, so that the noise is unknown.
enum class Standing { error, failed, regressed, changed, improved, passed };

/// How a scenario stands: by its criteria (error, failed or passed), then by its change if it has
/// any. \param comparison null without a baseline.
std::vector<Standing> standings_of(const ScenarioResult& scenario, const Comparison* comparison);

struct Remark {
  std::string scenario;
  std::vector<Standing> standings;   ///< as `standings_of`
  std::vector<std::string> reasons;  ///< texts, worst first
};

enum class Light {
  red,  ///< regressed or not judged; without a baseline: a criterion failed, or a run by an error
  yellow,  ///< a regression is neither found nor excluded
  green,
};

struct SuiteVerdict {
  std::optional<Finding> finding;  ///< absent without a baseline
  /// The finding and the counts: such as "equal: no loss above 0.004 of rebel.f1; of 280 means 0
  /// regressed, 1 improved; of 43 scenarios 0 regressed, 0 improved, 43 as before; 44 of 44
  /// criteria met, 0 failed"; without a baseline the criteria alone (`text_of(CriteriaCounts)`).
  std::string line;
  Light light = Light::green;
  std::string note = {};             ///< a caveat on the line; may be empty
  std::vector<Remark> remarks = {};  ///< worst first; only scenarios with reasons
};

/// States the changed figures, the missed criteria, and the filter's rule behind most of the missed
/// and false rebels, or behind most of those that are new since the baseline. The rule comes from
/// all events of the runs, if they have any.
/// \param before,comparison null without a baseline.
/// \param others the results of the detectors of `--beside`, whose criteria the line counts too.
SuiteVerdict verdict_of(const SuiteInFolder& after, const SuiteInFolder* before,
                        const Comparison* comparison, std::span<const SuiteResult> others = {});

/// The remarks and the note, without the line.
std::string text_of(const SuiteVerdict& verdict);

/// Such as "green".
const char* word_of(Light light);

/// The word for the user: such as "regressed".
const char* word_of(Standing standing);
/// Such as "passed, regressed".
std::string text_of(const std::vector<Standing>& standings);

}  // namespace lcs::suite
