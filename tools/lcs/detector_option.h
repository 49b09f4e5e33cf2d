/// \file
/// The option that chooses a detector.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scenarios/quantities.h"
#include "tools/comparators/detectors.h"
#include "tools/lcs/options.h"

namespace lcs::tools {

/// What watches, as it is asked for.
struct DetectorOptions {
  std::string name;     ///< "": lcs, or what a program or file is called
  std::string command;  ///< of a program; "" for none
  double timeout_s = comparators::Program{}.timeout_s;
  std::string detections;  ///< file; "" for none
};

/// The options that ask for a program again; none for another detector.
inline std::vector<std::string> arguments_of(const DetectorOptions& options) {
  if (options.command.empty()) return {};
  return {"--detector-command", options.command, "--detector-timeout",
          fmt::format("{} s", options.timeout_s)};
}

/// \throws std::invalid_argument as `comparators::spec_of` and its like.
inline comparators::DetectorSpec spec_of(const DetectorOptions& options) {
  if (!options.command.empty()) {
    return comparators::spec_of_program(options.name, {options.command, options.timeout_s});
  }
  if (!options.detections.empty()) {
    return comparators::spec_of_file(options.name, options.detections);
  }
  return comparators::spec_of(options.name.empty() ? "lcs" : options.name);
}

/// --detector, with all that there are and what each is, and how to give one's own.
inline void add_detector_option(CLI::App& command, DetectorOptions& options,
                                const std::string& more = "") {
  std::string about = "What watches; lcs if not given:";
  for (const comparators::DetectorKind& each : comparators::detectors()) {
    about += fmt::format("\n{:<10} {}", each.name, each.purpose);
  }
  command
      .add_option("--detector", options.name,
                  about + more + "\nWith a detector of yours: what it is called in the results")
      ->type_name("NAME");
  CLI::Option* own =
      command
          .add_option("--detector-command", options.command,
                      "A program of yours that watches, as 'python3 mine.py': it is handed each "
                      "frame on its standard input and answers with a line "
                      "(tools/comparators/PROTOCOL.md)")
          ->type_name("COMMAND");
  add_quantity_option(command, "--detector-timeout", scenario::kDuration, options.timeout_s,
                      fmt::format("That it may take to start, to answer and to end; {} s if not "
                                  "given",
                                  options.timeout_s))
      ->type_name("TIME")
      ->needs(own);
}

/// What stands behind it where presets are taken.
inline constexpr const char* kPresetDetector =
    "\nlcs:lab    the filter with the paper's preset, or another, and nothing that scenarios say "
    "of it";

/// --beside of one run, each with a folder of its own.
inline void add_beside_option(CLI::App& command, std::vector<std::string>& beside) {
  command
      .add_option(
          "--beside", beside,
          "Let this detector watch the same frames too, and write its figures and layers to "
          "the folder; may be repeated")
      ->type_name("NAME=DIR")
      ->group(kOutputs)
      ->allow_extra_args(false);
}

}  // namespace lcs::tools
