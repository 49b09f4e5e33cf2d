/// \file
/// `lcs preview`: shows a scenario's plan and its problems without running it.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct PreviewOptions {
  std::string scenario;  ///< scenario file
  std::string out;       ///< HTML file; "": out/preview/SCENARIO.html
  std::string mjcf;      ///< file for the world's MJCF; "": none
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;  ///< "key=value"
  bool force = false;
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_preview_command(CLI::App& app, PreviewOptions& options);

/// \throws input::Error, bench::OutputError, std::exception; then no page is written.
ExitCode preview(const PreviewOptions& options);

}  // namespace lcs::tools
