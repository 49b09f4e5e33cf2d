/// \file
/// `lcs replay`: runs a detector on a recording that options describe instead of a scenario file.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/app/replay.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct ReplayOptions {
  app::ReplayRequest request;
  std::string write;  ///< scenario file to write instead of running; "": run
  bool force = false;
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_replay_command(CLI::App& app, ReplayOptions& options);

/// \throws as `app::replay`.
ExitCode replay(const ReplayOptions& options);

}  // namespace lcs::tools
