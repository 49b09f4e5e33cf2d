/// \file
/// `lcs generate`: writes scenarios as sequences of pictures and truth for other tools.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/generate.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct GenerateOptions {
  app::GenerateRequest request;
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_generate_command(CLI::App& app, GenerateOptions& options);

/// \return kError if a sequence of a suite could not be made. \throws as `app::generate`.
ExitCode generate(const GenerateOptions& options);

}  // namespace lcs::tools
