/// \file
/// `lcs generate`: writes scenarios as sequences of pictures and truth for other tools.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct GenerateOptions {
  std::vector<std::string> paths;    ///< one scenario file; with `suite`: files and folders
  bool suite = false;                ///< one sequence for each scenario and seed
  std::string out;                   ///< folder; "" is data/<scenario's name>, data with `suite`
  std::vector<std::string> formats;  ///< empty: all
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;     ///< "key=value"
  int frames = 0;                    ///< 0: all frames of the scenario
  int jobs = 1;                      ///< concurrent processes
  std::string shard;                 ///< "i/n": only this part; "" is all
  std::optional<std::string> group;  ///< with `suite`: as in `SuiteOptions`
  std::string filter;                ///< as in `SuiteOptions`
  int seeds = 1;                     ///< per scenario, with `suite`
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_generate_command(CLI::App& app, GenerateOptions& options);

/// \throws input::Error, bench::OutputError, sequence::TruthError, sim::PhysicsError,
///   std::exception. Complete frames are kept, and the same command resumes after them.
ExitCode generate(const GenerateOptions& options);

/// Makes the sequences of a suite. \return kError if a sequence could not be made.
ExitCode generate_suite(const GenerateOptions& options);

/// The arguments of a child process that makes one sequence or a part of it.
std::vector<std::string> sequence_command(const GenerateOptions& options,
                                          const std::string& scenario, const std::string& out);

}  // namespace lcs::tools
