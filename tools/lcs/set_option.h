/// \file
/// What options of all sub-commands have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lcs::tools {

/// Of every option and argument of every sub-command: nothing between quotes is a slip, as of a
/// variable of a shell that is not set, and not the same as an option that is not given.
inline void refuse_empty_options(CLI::App& app) {
  const auto complaint = [](const std::string& text) -> std::string {
    return text.empty() ? "is given without a value; give one, or leave it out" : "";
  };
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0) option->check(complaint, "");
    }
  }
}

/// One setting behind each `--set`, so that what follows it is not taken for another.
inline void add_set_option(CLI::App& command, std::vector<std::string>& sets,
                           const std::string& about) {
  command.add_option("--set", sets, about + "; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

}  // namespace lcs::tools
