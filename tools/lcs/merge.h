/// \file
/// `lcs merge`: joins the parts of a suite that `lcs suite --shard` made.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/merge.h"
#include "tools/lcs/exit_codes.h"
#include "tools/lcs/suite_end.h"

namespace lcs::tools {

struct MergeOptions {
  app::MergeRequest request;
  SuiteEndOptions end;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_merge_command(CLI::App& app, MergeOptions& options);

/// \throws as `app::merge`.
ExitCode merge(const MergeOptions& options);

}  // namespace lcs::tools
