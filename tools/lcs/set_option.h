/// \file
/// `--set KEY=VALUE`, as all sub-commands take it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lcs::tools {

/// One setting behind each `--set`, so that what follows it is not taken for another.
inline void add_set_option(CLI::App& command, std::vector<std::string>& sets,
                           const std::string& about) {
  command.add_option("--set", sets, about + "; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

}  // namespace lcs::tools
