/// \file
/// `lcs world`: draws a scenario and its scene at random from a seed.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/world.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct WorldOptions {
  app::WorldRequest request;
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_world_command(CLI::App& app, WorldOptions& options);

/// \throws as `app::world`.
ExitCode world(const WorldOptions& options);

}  // namespace lcs::tools
