/// \file
/// `lcs likeness`: corners of drawn worlds, of the project's scenarios and of recordings, side by
/// side.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"
#include "tools/lcs/suite_worlds.h"

namespace lcs::tools {

struct LikenessOptions {
  WorldsOptions worlds;
  bool suite = false;
  std::vector<std::string> recordings;  ///< "NAME=FOLDER"
  int fast_threshold = 20;              ///< for recordings, grey levels
  int pairs = 12;                       ///< of pictures, of each run
  std::string out = "out/likeness";
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_likeness_command(CLI::App& app, LikenessOptions& options);

/// \throws scenario::Error, bench::OutputError, Interrupted, std::exception; then there is no new
///   output, and an earlier one is as it was.
ExitCode likeness(const LikenessOptions& options);

}  // namespace lcs::tools
