/// \file
/// The worlds that a command runs. Missing worlds are drawn first.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/suite/plan.h"
#include "tools/suite/suite_result.h"
#include "tools/worlds/worlds.h"

namespace lcs::tools {

struct WorldsOptions {
  std::string split;  ///< train, validate or test; "": no worlds
  int count = 60;
  std::string family;  ///< "": all families
};

/// Adds `--worlds`, `--count` and `--family`. \return the option `--worlds`.
CLI::Option* add_worlds_options(CLI::App& command, WorldsOptions& options);

/// The chosen worlds, ordered by family, without drawing them.
/// \throws std::invalid_argument for an unknown split or family.
std::vector<worlds::Kept> chosen_worlds(const WorldsOptions& options);

/// Draws the worlds that are missing in out/worlds/, each in its own process, `jobs` at a time.
/// \throws bench::OutputError for a world that was edited, Interrupted, std::runtime_error.
void draw_worlds(const std::vector<worlds::Kept>& chosen, std::size_t jobs);

/// Adds to `result` how each world was drawn, from the worlds' scenario files.
void add_origins(suite::SuiteResult& result);

/// Text lines for the user: the number of redraws, and for the split `test` its purpose.
std::string told_of_worlds(const suite::SuiteResult& result);

/// Writes worlds/ into the folder of a suite: a picture of each world, from its first run.
/// \param plan the plan that `result` came from, in the same order.
/// \throws bench::OutputError, Interrupted; std::runtime_error if a run's files cannot be read.
void write_sheets(const std::filesystem::path& folder,
                  const std::vector<suite::PlannedScenario>& plan,
                  const suite::SuiteResult& result);

}  // namespace lcs::tools
