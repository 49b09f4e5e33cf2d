/// \file
/// `lcs run`: simulates a scenario, runs a detector on its frames, scores it and reports.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/run.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct RunOptions {
  app::RunRequest request;
  bool view = false;  ///< show the run in a window
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_run_command(CLI::App& app, RunOptions& options);

/// \throws as `app::run`.
ExitCode run(const RunOptions& options);

/// Prints the figures and the missed criteria of a run.
ExitCode show_run(const app::RunMade& made, bool quiet);

}  // namespace lcs::tools
