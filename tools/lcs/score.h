/// \file
/// `lcs score`: computes a run's figures from its files, for its own or another detector.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct ScoreOptions {
  std::string sequence;          ///< folder of a run
  std::string detections;        ///< CSV file; "": score the run's own detector
  std::string out;               ///< file for the figures; "": none
  std::string write_detections;  ///< CSV file for the verdicts; "": none
  bool force = false;
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_score_command(CLI::App& app, ScoreOptions& options);

/// \throws input::Error, bench::OutputError, std::exception.
ExitCode score(const ScoreOptions& options);

}  // namespace lcs::tools
