/// \file
/// `lcs replay`: the filter on a folder of pictures, without a truth to score it by.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct ReplayOptions {
  std::string images;       ///< folder
  double fps = 0;           ///< pictures a second, > 0
  double speed_mps = 0;     ///< along the optical axis; negative is reverse
  double focal_px = 0;      ///< > 0
  int fast_threshold = 20;  ///< grey levels
  std::string preset = "default";
  std::vector<std::string> sets;  ///< "key=value" of the filter
  std::string out;                ///< folder; "" is out/<folder's name>
  bool no_video = false;
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_replay_command(CLI::App& app, ReplayOptions& options);

/// \throws bench::OutputError, Interrupted, std::exception; then there is no new output, and an
///   earlier one is as it was.
ExitCode replay(const ReplayOptions& options);

}  // namespace lcs::tools
