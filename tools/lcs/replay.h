/// \file
/// `lcs replay`: runs a detector on a recording that options describe instead of a scenario file.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "tools/lcs/detector_option.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct ReplayOptions {
  std::string path;                              ///< folder or video of the recording
  std::map<std::string, std::string> recording;  ///< keys and values of a scenario's `recording`
  std::string ego_motion;                        ///< imu or truth; "": the recording's default
  std::string fast_threshold;                    ///< "": the recording's default
  std::string preset;                            ///< "": the recording's default
  std::vector<std::string> sets;                 ///< filter settings, "key=value"
  app::DetectorChoice detector;
  std::vector<std::string> beside;  ///< as in `RunOptions`
  std::string out;                  ///< folder; "" is out/<name of the recording>
  std::string write;                ///< scenario file to write instead of running; "": run
  bool force = false;
  bool no_video = false;
  bool events = false;
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_replay_command(CLI::App& app, ReplayOptions& options);

/// \throws as `run`.
ExitCode replay(const ReplayOptions& options);

}  // namespace lcs::tools
