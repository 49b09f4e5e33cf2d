/// \file
/// From a YAML file and `--set key=value` to a validated `Scenario`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

struct LoadOptions {
  std::vector<std::string> sets;      ///< "ego.speed=0.7 m/s": replaces or adds a value, in order
  std::optional<std::uint64_t> seed;  ///< replaces the file's
};

/// Reads, checks and converts a scenario.
/// \throws Error naming file, line, what is wrong and what to do (unknown keys with the nearest
///   known one, wrong units and types, values out of range or not finite, missing files).
Scenario load(const std::filesystem::path& file, const LoadOptions& options = {});

/// Checks and converts a document that was not read from a file. \param file gives the scenario its
/// name (the stem) and the folder that relative paths begin at; it need not exist.
Scenario load(Value root, const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace lcs::scenario
