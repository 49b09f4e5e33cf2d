/// \file
/// The command-line options that choose worlds.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/suite_worlds.h"
#include "tools/lcs/options.h"

namespace lcs::tools {

/// Adds `--worlds`, `--count` and `--family`. \return the option `--worlds`.
inline CLI::Option* add_worlds_options(CLI::App& command, app::WorldsChoice& options) {
  constexpr int kMostWorlds = 100'000;
  CLI::Option* split = command
                           .add_option("--worlds", options.split,
                                       "Run worlds in place of scenario files: those of the split "
                                       "train, validate or test")
                           ->type_name("SPLIT");
  add_integer_option(command, "--count", options.count, "How many worlds; 60 if not given", 1,
                     kMostWorlds)
      ->type_name("N")
      ->needs(split);
  command.add_option("--family", options.family, "Only worlds of this family")
      ->type_name("NAME")
      ->needs(split);
  return split;
}

}  // namespace lcs::tools
