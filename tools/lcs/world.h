/// \file
/// `lcs world`: a scenario and its scene, drawn from a seed.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct WorldOptions {
  std::string family;
  std::uint64_t seed = 1;
  std::string out;       ///< folder; "": out/worlds/FAMILY_SEED
  std::string pictures;  ///< folder to take surfaces from; "": none
  bool sheet = false;
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_world_command(CLI::App& app, WorldOptions& options);

/// \throws bench::OutputError, std::exception; then there is no new world.
ExitCode world(const WorldOptions& options);

}  // namespace lcs::tools
