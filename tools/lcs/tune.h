/// \file
/// `lcs tune`: the filter's learnt numbers, from recorded runs of `train`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct TuneOptions {
  std::vector<std::string> suites;
  std::vector<std::string> validate;  ///< likewise
  std::vector<std::string> keys;
  std::vector<std::string> sets;
  int evaluations = 300;
  std::uint64_t seed = 1;
  std::string out = "out/tune";
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_tune_command(CLI::App& app, TuneOptions& options);

/// \throws std::exception, Interrupted; then what was evaluated so far is kept.
ExitCode tune(const TuneOptions& options);

}  // namespace lcs::tools
