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
  std::string scenario;              ///< file
  std::string out;                   ///< folder; "" is data/<scenario's name>
  std::vector<std::string> formats;  ///< none: all
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;  ///< "key=value"
  int frames = 0;                 ///< 0: as many as the scenario has
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_generate_command(CLI::App& app, GenerateOptions& options);

/// \throws scenario::Error, bench::OutputError, sequence::TruthError, sim::PhysicsError,
///   std::exception; then the frames that are whole are there, and the same command goes on.
ExitCode generate(const GenerateOptions& options);

}  // namespace lcs::tools
