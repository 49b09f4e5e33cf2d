/// \file
/// The commands of the program. Each parses its options, calls a function of tools/app and prints.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct Command {
  const CLI::App& options;
  /// To be called if the options were parsed. \throws as the function of tools/app.
  std::function<ExitCode()> carry_out;
};

/// \name Each adds its sub-command to `app`.
///@{
Command add_run_command(CLI::App& app);
Command add_preview_command(CLI::App& app);
Command add_replay_command(CLI::App& app);
Command add_score_command(CLI::App& app);
Command add_suite_command(CLI::App& app);
Command add_merge_command(CLI::App& app);
Command add_generate_command(CLI::App& app);
Command add_compare_command(CLI::App& app);
Command add_kinematics_command(CLI::App& app);
Command add_world_command(CLI::App& app);
Command add_tune_command(CLI::App& app);
///@}

}  // namespace lcs::tools
