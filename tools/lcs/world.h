/// \file
/// `lcs world`: draws a scenario and its scene at random from a seed.
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
  std::string pictures;  ///< folder of pictures for textures; "": none
  bool sheet = false;
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_world_command(CLI::App& app, WorldOptions& options);

/// \throws bench::OutputError, std::exception; then no world is written.
ExitCode world(const WorldOptions& options);

}  // namespace lcs::tools
