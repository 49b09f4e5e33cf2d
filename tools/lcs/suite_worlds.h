/// \file
/// The worlds that a command runs. Missing worlds are drawn first.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/suite/plan.h"
#include "tools/suite/suite_result.h"

namespace lcs::tools {

struct WorldsOptions {
  std::string split;  ///< train, validate or test; "": no worlds
  int count = 60;
  std::string family;  ///< "": all families
};

/// Adds `--worlds`, `--count` and `--family`. \return the option `--worlds`.
CLI::Option* add_worlds_options(CLI::App& command, WorldsOptions& options);

/// Draws the missing worlds into out/worlds/, each in its own process, `jobs` at a time.
/// \return the scenario files of all worlds, ordered by family.
/// \throws std::invalid_argument for an unknown split or family, Interrupted, std::runtime_error.
std::vector<std::string> make_worlds(const WorldsOptions& options, std::size_t jobs);

/// Adds to `result` how each world was drawn, from the worlds' scenario files.
void add_origins(suite::SuiteResult& result);

/// Text lines for the user: the number of redraws, and for the split `test` its purpose.
std::string told_of_worlds(const WorldsOptions& options, const suite::SuiteResult& result);

/// Writes worlds.html and worlds/ into the folder of a suite, with pictures from its runs.
/// \param plan the plan that `result` came from, in the same order.
/// \throws bench::OutputError, Interrupted; std::runtime_error if a run's files cannot be read.
void write_worlds(const std::filesystem::path& folder, const WorldsOptions& options,
                  const std::vector<suite::PlannedScenario>& plan, const suite::SuiteResult& result,
                  std::span<const suite::SuiteResult> others);

}  // namespace lcs::tools
