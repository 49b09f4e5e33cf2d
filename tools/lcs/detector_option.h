/// \file
/// The option that chooses a detector.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/comparators/detectors.h"

namespace lcs::tools {

/// --detector, with all that there are and what each is.
inline void add_detector_option(CLI::App& command, std::string& detector,
                                const std::string& more = "") {
  std::string about = "What watches; lcs if not given:";
  for (const comparators::Detector& each : comparators::detectors()) {
    about += fmt::format("\n{:<10} {}", each.name, each.purpose);
  }
  command.add_option("--detector", detector, about + more)->type_name("NAME");
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
      ->allow_extra_args(false);
}

}  // namespace lcs::tools
