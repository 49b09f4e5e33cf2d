/// \file
/// Loads a YAML file with `--set key=value` assignments into a validated `Scenario`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/input/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

struct LoadOptions {
  std::vector<std::string> sets;      ///< "ego.speed=0.7 m/s": replaces or adds a value, in order
  std::optional<std::uint64_t> seed;  ///< replaces the file's seed
};

/// Reads, checks and converts a scenario.
/// \throws Error with file, line, problem and remedy: unknown keys (with the nearest known key),
/// wrong units and types, values out of range or not finite, missing files.
Scenario load(const std::filesystem::path& file, const LoadOptions& options = {});

/// Checks and converts a document that is already parsed. \param file its stem names the scenario,
/// its folder is the base of relative paths; it need not exist.
Scenario load(input::Value root, const std::filesystem::path& file,
              const LoadOptions& options = {});

}  // namespace lcs::scenario
