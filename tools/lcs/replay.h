/// \file
/// `lcs replay`: a detector on a recording, without a truth to score it by.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct ReplayOptions {
  std::string folder;                 ///< of the recording
  std::string layout = "auto";        ///< of the folder
  std::string camera;                 ///< of several; "" is the layout's first
  std::optional<double> fps;          ///< pictures a second, > 0
  std::optional<double> speed_mps;    ///< along the optical axis; negative is reverse
  std::string imu;                    ///< CSV file; "" for none
  std::optional<double> focal_px;     ///< > 0
  std::vector<double> centre_px;      ///< x, y; none: the middle
  std::vector<double> mount_rpy_rad;  ///< none: the layout's own
  std::string ego_motion;             ///< imu or truth; "": as the recording has it
  std::string detector = "lcs";
  /// Of corners, grey levels; none within: as each picture shows.
  std::optional<std::optional<int>> fast_threshold;
  std::string preset;                 ///< "": as the recording has it
  std::vector<std::string> sets;      ///< "key=value" of the filter
  std::string out;                    ///< folder; "" is out/<folder's name>
  bool no_video = false;
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_replay_command(CLI::App& app, ReplayOptions& options);

/// \throws bench::OutputError, Interrupted, std::exception; then there is no new output, and an
///   earlier one is as it was.
ExitCode replay(const ReplayOptions& options);

}  // namespace lcs::tools
