/// \file
/// `lcs preview`: a scenario looked at before it is run.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct PreviewOptions {
  std::string scenario;  ///< file
  std::string out;       ///< page; "": out/preview/SCENARIO.html
  std::string mjcf;      ///< file for the world; "": none
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;  ///< "key=value"
  bool force = false;
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_preview_command(CLI::App& app, PreviewOptions& options);

/// \throws scenario::Error, bench::OutputError, std::exception; then there is no new page.
ExitCode preview(const PreviewOptions& options);

}  // namespace lcs::tools
