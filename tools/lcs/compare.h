/// \file
/// `lcs compare`: the differences between two suites beyond the noise of their seeds.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct CompareOptions {
  std::string before, after;  ///< suite.json, or its folder
  std::string metric;         ///< regular expression; "": every metric
  bool all = false;
  std::string markdown;     ///< folder for the summary of a merge request; "": none
  std::string pictures_at;  ///< address of its pictures; "": beside it
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_compare_command(CLI::App& app, CompareOptions& options);

/// \return kRegressed for a regression. \throws std::runtime_error if a suite cannot be read or
///   the two have no scenario in common.
ExitCode compare(const CompareOptions& options);

}  // namespace lcs::tools
