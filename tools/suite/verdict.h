/// \file
/// A suite in one line, and what is worst in it with the reason, before any table.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// A suite that was read or made, and where the folders of its runs are.
struct SuiteInFolder {
  const SuiteResult& suite;
  std::filesystem::path folder;
};

enum class Standing { error, regressed, failed, improved };  ///< worst first

struct Remark {
  std::string scenario;
  Standing standing;
  std::vector<std::string> reasons;  ///< in words, worst first
};

struct Verdict {
  /// "1 regressed, 0 improved, 42 as before, 1 criterion missed", counted by scenarios; without a
  /// baseline "43 criteria met, 1 missed".
  std::string line;
  std::string note;             ///< what is to be known of the line; empty for nothing
  std::vector<Remark> remarks;  ///< worst first; of a scenario with nothing to say none
};

/// Which figures changed by how much, which criteria are missed, and the rule that took most of the
/// rebels that are missed or false, or that are so since the baseline: by all events of both where
/// their runs have them.
/// \param comparison of the two; both null without a baseline.
Verdict verdict_of(const SuiteInFolder& after, const SuiteInFolder* before,
                   const Comparison* comparison);

/// The remarks, the note and, last, the line.
std::string text_of(const Verdict& verdict);

/// The word that people read: "error", "regressed", "failed", "improved".
const char* word_of(Standing standing);

}  // namespace lcs::suite
