/// \file
/// `lcs run`: simulates a scenario, runs a detector on its frames, scores it and reports.
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
  std::string scenario;  ///< scenario file
  std::string out;       ///< folder; "" is out/<scenario's name>
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;  ///< "key=value"
  std::string frames = {};        ///< number of frames; "": as in the scenario
  app::DetectorChoice detector;
  std::vector<std::string> beside;  ///< "detector=folder": further detectors on the same frames
  std::string recorded;  ///< folder of an earlier run that provides the frames; "": simulate
  bench::Keep keep = bench::Keep::all;
  bool gzip = false;  ///< compress layers and truth
  bool no_video = false;
  bool events = false;
  bool report = false;  ///< write report.html, and with it events.json
  bool view = false;    ///< show the run in a window
  bool quiet = false;
  std::vector<std::string> command = {};  ///< of a request that is carried out as this one
};

/// As `run`, for a loaded scenario: `options.seed` is ignored; `options.scenario`, `sets` and
/// `frames` only appear in the report. \throws as `run`.
ExitCode run_scenario(const RunOptions& options, scenario::Scenario scenario);

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_run_command(CLI::App& app, RunOptions& options);

/// \throws input::Error, bench::OutputError, sim::PhysicsError, Interrupted, std::exception;
///   then no output is written, and earlier output is unchanged.
ExitCode run(const RunOptions& options);

}  // namespace lcs::tools
