/// \file
/// `lcs replay`: runs a detector on a recording that options describe instead of a scenario file.
#include <string>

#include "tools/app/replay.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

struct ReplayOptions {
  app::ReplayRequest request;
  std::string write;  ///< scenario file to write instead of running; "": run
  bool force = false;
  bool quiet = false;
};

ExitCode replay(const ReplayOptions& options) {
  if (!options.write.empty()) {
    app::write_scenario(options.request, options.write, files::overwrite(options.force));
    return kFine;
  }
  Terminal terminal(options.quiet);
  return show_run(app::replay(options.request, terminal), options.quiet, scoring::Format::text);
}

app::Options options_of(ReplayOptions& options) {
  app::Options all = app::options_of(options.request);
  all.add("--write", "FILE", &options.write,
          "Write the scenario that the options make to this file, and run nothing",
          {.is_output = true});
  all.add_force(options.force);
  all.add_quiet(options.quiet);
  return all;
}

}  // namespace

Command replay_command() {
  return command_of("Run the LCS filter (or a comparator) on a recording", kReplayHelp, &replay);
}

}  // namespace lcs::tools
