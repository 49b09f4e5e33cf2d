/// \file
/// The command line of the program: parses the words, and carries out the command that they name.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tools/app/option.h"
#include "tools/scoring/table.h"

namespace lcs::tools {

enum ExitCode : int {
  kFine = 0,
  kCriterionFailed = 1,  ///< the run completed but missed a required criterion
  kRegressed = 1,        ///< the second of two suites is worse
  kError = 2,            ///< stderr has one message: the error, its place and the remedy
  kInterrupted = 130,    ///< by a termination signal; 128 + SIGINT, as shells report it
};

struct Command {
  std::string about;
  std::string help;  ///< below the options
  app::Options options;
  /// To be called if the options were parsed. \throws as the function of tools/app.
  std::function<ExitCode()> carry_out;
};

/// \param help below the options. \param carry_out gets options of which `options_of` is the list.
template <class Chosen>
Command command_of(const std::string& about, std::string_view help,
                   ExitCode (*carry_out)(const Chosen&)) {
  const auto chosen = std::make_shared<Chosen>();
  return {about, std::string(help), options_of(*chosen), [=] { return carry_out(*chosen); }};
}

/// A request, and whether its command prints only errors and warnings.
template <class Request>
struct Quietable {
  Request request;
  bool quiet = false;
};
template <class Request>
app::Options options_of(Quietable<Request>& chosen) {
  app::Options all = options_of(chosen.request);
  all.add_quiet(chosen.quiet);
  return all;
}

/// Adds `--format`, of the tables that the command prints.
void add_format(app::Options& all, scoring::Format& format);

/// Tells on standard error why the program ends. \return its exit code.
int fail(const std::string& message);

/// \param help of the program, below the commands. \return the exit code.
/// \throws what the command throws.
int run_command_line(const std::vector<Command>& commands, std::string_view help, int argc,
                     char** argv);

}  // namespace lcs::tools
