/// \file
/// Computes figures from the files of a run or suite, for its own or another detector.
#pragma once

#include <optional>
#include <string>

#include "tools/app/caller.h"
#include "tools/app/option.h"
#include "tools/scoring/scoring.h"
#include "tools/suite/suite_result.h"

namespace lcs::app {

struct ScoreRequest {
  std::string sequence = {};          ///< folder of a run, or of a suite
  std::string detections = {};        ///< CSV file; "": score the run's own detector
  std::string out = {};               ///< file for the figures; "": none
  std::string write_detections = {};  ///< CSV file for the verdicts; "": none
  bool force = false;                 ///< replace files that lcs did not write
};

Options options_of(ScoreRequest& request);

/// The figures of a run; of a suite only `suite` is set.
struct Scored {
  recording::RunInfo run = {};
  int frames = 0;
  scoring::Metrics metrics = {};
  std::optional<suite::SuiteResult> suite = {};  ///< with the figures of all runs anew
};

/// \throws input::Error, files::OutputError, std::exception; then nothing is written.
Scored score(const ScoreRequest& request, Caller& caller);

}  // namespace lcs::app
