/// \file
/// `lcs suite`: runs many scenarios with several seeds each in parallel and prints one table.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/suite.h"
#include "tools/lcs/exit_codes.h"
#include "tools/lcs/suite_end.h"

namespace lcs::tools {

struct SuiteOptions {
  app::SuiteRequest request;
  bool list = false;
  SuiteEndOptions end;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_suite_command(CLI::App& app, SuiteOptions& options);

/// \throws as `app::suite`.
ExitCode suite(const SuiteOptions& options);

}  // namespace lcs::tools
