/// \file
/// `lcs compare`: what two suites differ in, beyond the noise of their seeds.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct CompareOptions {
  std::string before, after;  ///< suite.json, or its folder
  std::string metric;         ///< regular expression; "" is any
  bool all = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_compare_command(CLI::App& app, CompareOptions& options);

/// \return kRegressed for a regression. \throws std::runtime_error for what cannot be read or
///   compared.
ExitCode compare(const CompareOptions& options);

}  // namespace lcs::tools
