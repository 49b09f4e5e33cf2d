/// \file
/// The worlds that a command runs, drawn where they are not there yet.
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
  std::string split;  ///< "": no worlds
  int count = 60;
  std::string family;  ///< "": all
};

/// Adds `--worlds`, which is returned, `--count` and `--family`.
CLI::Option* add_worlds_options(CLI::App& command, WorldsOptions& options);

/// Makes the worlds in out/worlds/, each by a process of its own, `jobs` at a time.
/// \return their scenario files, family by family.
/// \throws std::invalid_argument for an unknown split or family, Interrupted, std::runtime_error.
std::vector<std::string> make_worlds(const WorldsOptions& options, std::size_t jobs);

/// Adds what the worlds' files say of how they were drawn.
void add_origins(suite::SuiteResult& result);

/// How often worlds were drawn again, and what worlds of `test` are for: lines for people.
std::string told_of_worlds(const WorldsOptions& options, const suite::SuiteResult& result);

/// Leaves worlds.html and worlds/ in the folder of a suite, with pictures that its runs have left.
/// \param plan of which `result` came, in the same order.
/// \throws bench::OutputError, Interrupted; std::runtime_error for what a run has left and cannot
///   be read.
void write_worlds(const std::filesystem::path& folder, const WorldsOptions& options,
                  const std::vector<suite::PlannedScenario>& plan, const suite::SuiteResult& result,
                  std::span<const suite::SuiteResult> others);

}  // namespace lcs::tools
