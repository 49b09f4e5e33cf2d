/// \file
/// `lcs replay`: a detector on a recording, by options in place of a scenario.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "tools/lcs/detector_option.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct ReplayOptions {
  std::string path;                              ///< of the recording
  std::map<std::string, std::string> recording;  ///< keys of a scenario's `recording`, as given
  std::string ego_motion;                        ///< imu or truth; "": as the recording has it
  std::string fast_threshold;                    ///< "": as the recording has it
  std::string preset;                            ///< "": as the recording has it
  std::vector<std::string> sets;                 ///< "key=value" of the filter
  DetectorOptions detector;
  std::vector<std::string> beside;  ///< as `RunOptions`
  std::string out;                  ///< folder; "" is out/<name of the recording>
  std::string write;                ///< file for the scenario, and nothing is run; "": run it
  bool force = false;
  bool no_video = false;
  bool events = false;
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_replay_command(CLI::App& app, ReplayOptions& options);

/// \throws as `run`.
ExitCode replay(const ReplayOptions& options);

}  // namespace lcs::tools
