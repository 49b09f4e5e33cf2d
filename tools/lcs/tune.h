/// \file
/// `lcs tune`: learns the filter's parameters from recorded runs of the split `train`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct TuneOptions {
  std::vector<std::string> suites;
  std::vector<std::string> validate;  ///< suites on which the result is only stated
  std::vector<std::string> keys;
  std::vector<std::string> sets;
  int evaluations = 300;
  std::uint64_t seed = 1;
  std::string out = "out/tune";
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_tune_command(CLI::App& app, TuneOptions& options);

/// \throws std::exception. All finished evaluations are kept.
ExitCode tune(const TuneOptions& options);

}  // namespace lcs::tools
