/// \file
/// The command-line options that choose a detector.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scenarios/quantities.h"
#include "tools/app/detector_choice.h"
#include "tools/lcs/options.h"

namespace lcs::tools {

/// Adds --detector, whose help lists all detectors, --detector-command and --detector-timeout.
inline void add_detector_option(CLI::App& command, app::DetectorChoice& options,
                                const std::string& more = "") {
  std::string about = "The detector; lcs if not given:";
  for (const comparators::DetectorKind& each : comparators::detectors()) {
    about += fmt::format("\n{:<10} {}", each.name, each.purpose);
  }
  command
      .add_option("--detector", options.name,
                  about + more + "\nFor a detector of yours: its name in the results")
      ->type_name("NAME");
  CLI::Option* own =
      command
          .add_option(
              "--detector-command", options.command,
              "A detector of yours, as 'python3 mine.py': the program reads each frame from "
              "its standard input and answers with a line "
              "(tools/comparators/PROTOCOL.md)")
          ->type_name("COMMAND");
  add_quantity_option(command, "--detector-timeout", scenario::kDuration, options.timeout_s,
                      fmt::format("Limit of the time to start, to answer a frame, and to end; {} s "
                                  "if not given",
                                  options.timeout_s))
      ->type_name("TIME")
      ->needs(own);
}

/// Further help text of --detector, for commands that accept filter presets.
inline constexpr const char* kPresetDetector =
    "\nlcs:lab    the filter with the paper's preset, or another, without the scenario's filter "
    "settings";

/// Adds --beside for a single run: each further detector has its own output folder.
inline void add_beside_option(CLI::App& command, std::vector<std::string>& beside) {
  command
      .add_option("--beside", beside,
                  "Run this detector on the same frames too, and write its figures and layers to "
                  "the folder; may be repeated")
      ->type_name("NAME=DIR")
      ->group(kOutputs)
      ->allow_extra_args(false);
}

}  // namespace lcs::tools
