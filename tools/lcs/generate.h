/// \file
/// `lcs generate`: scenarios written out as sequences that other tools read.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct GenerateOptions {
  std::vector<std::string> paths;    ///< one scenario file; with `suite` files and folders, or none
  bool suite = false;                ///< many sequences, one a scenario and seed
  std::string out;                   ///< folder; "" is data/<scenario's name>, data with `suite`
  std::vector<std::string> formats;  ///< none: all
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;     ///< "key=value"
  int frames = 0;                    ///< 0: as many as the scenario has
  int jobs = 1;                      ///< processes at a time
  std::string shard;                 ///< "i/n": only this part; "" is all
  std::optional<std::string> group;  ///< with `suite`: as `lcs suite` has it
  std::string filter;                ///< likewise
  int seeds = 1;                     ///< likewise
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_generate_command(CLI::App& app, GenerateOptions& options);

/// \throws scenario::Error, bench::OutputError, sequence::TruthError, sim::PhysicsError,
///   std::exception; then the frames that are whole are there, and the same command goes on.
ExitCode generate(const GenerateOptions& options);

/// The same with `suite`. \return kError if one of the sequences could not be made.
ExitCode generate_suite(const GenerateOptions& options);

/// The arguments of a process that makes one sequence, or a part of it.
std::vector<std::string> sequence_command(const GenerateOptions& options,
                                          const std::string& scenario, const std::string& out);

/// i and n of "i/n". \throws std::invalid_argument unless 1 <= i <= n.
std::pair<int, int> shard_of(const std::string& text);

}  // namespace lcs::tools
