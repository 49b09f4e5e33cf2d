/// \file
/// The differences between two suites beyond the noise of their seeds.
#pragma once

#include <string>
#include <vector>

#include "tools/app/option.h"
#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"
#include "tools/suite/verdict.h"

namespace lcs::app {

struct CompareRequest {
  std::string before, after;   ///< suite.json, or its folder
  std::string metric;          ///< regular expression; "": every metric
  std::string markdown;        ///< folder for the summary of a merge request; "": none
  bool allow_missing = false;  ///< judges though runs of `before` are missing in `after`
  std::string pictures_at;     ///< address of its pictures; "": beside it
};

Options options_of(CompareRequest& request);

struct Compared {
  suite::SuiteResult before, after;
  suite::Comparison comparison = {};
  suite::SuiteVerdict verdict = {};
  std::vector<std::string> warnings = {};
};

/// \throws std::runtime_error if a suite cannot be read or the two have no scenario in common.
Compared compare(const CompareRequest& request);

}  // namespace lcs::app
