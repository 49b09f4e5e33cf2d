/// \file
/// `lcs compare`: the differences between two suites beyond the noise of their seeds.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/compare.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct CompareOptions {
  app::CompareRequest request;
  bool all = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_compare_command(CLI::App& app, CompareOptions& options);

/// \return kRegressed for a regression. \throws as `app::compare`.
ExitCode compare(const CompareOptions& options);

}  // namespace lcs::tools
