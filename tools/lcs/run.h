/// \file
/// `lcs run`: a scenario simulated, watched by a detector, scored and reported.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/lcs/detector_option.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct RunOptions {
  std::string scenario;  ///< file
  std::string out;       ///< folder; "" is out/<scenario's name>
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;  ///< "key=value"
  std::string frames = {};        ///< that many, instead of the scenario's; "" for those
  DetectorOptions detector;
  std::vector<std::string> beside;  ///< "detector=folder": others that watch the same frames
  std::string recorded;  ///< folder of an earlier run to take the frames from; "": simulate
  bool no_video = false;
  bool events = false;
  bool report = false;  ///< with the events
  bool view = false;    ///< in a window, while it goes on
  bool quiet = false;
};

/// The same for a scenario that is loaded: `options.scenario`, `seed` and `sets` are not looked at.
/// \throws as `run`.
ExitCode run_scenario(const RunOptions& options, scenario::Scenario scenario);

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_run_command(CLI::App& app, RunOptions& options);

/// \throws scenario::Error, bench::OutputError, sim::PhysicsError, Interrupted, std::exception;
///   then there is no new output, and an earlier one is as it was.
ExitCode run(const RunOptions& options);

}  // namespace lcs::tools
