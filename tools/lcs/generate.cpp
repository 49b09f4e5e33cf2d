/// \file
/// `lcs generate`: writes scenarios as sequences of pictures and truth for other tools.
#include "tools/app/generate.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

using GenerateFlags = Quietable<app::GenerateRequest>;

ExitCode generate(const GenerateFlags& options) {
  Terminal terminal(options.quiet);
  if (options.request.is_of_many()) {
    return app::generate_suite(options.request, terminal).errors.empty() ? kFine : kError;
  }
  app::GenerateRequest request = options.request;
  if (request.paths.size() == 1) {  // other numbers are refused
    request.paths.front() = scenario_file(request.paths.front()).string();
  }
  const app::Generated made = app::generate(request, terminal);
  if (options.quiet) return kFine;
  switch (made.state) {
    case app::Generated::State::complete_before:
      print_out("{} is complete, and every file is as its manifest says\n", made.folder.string());
      break;
    case app::Generated::State::part:
      print_out(
          "{}: frames {} to {} are whole; when all parts are, the same command without "
          "--shard puts the sequence together\n",
          made.scenario.name, made.range.first, made.range.last - 1);
      break;
    case app::Generated::State::whole:
      print_out("{}: {} frames, seed {}\n", made.scenario.name, made.scenario.frames,
                made.scenario.seed);
      for (const std::string& note : made.notes) print_out("  {}\n", note);
      print_out("  files    {}\n", made.folder.string());
  }
  return kFine;
}

}  // namespace

Command generate_command() {
  return command_of("Simulate a scenario and write it as a sequence that other tools read",
                    kGenerateHelp, &generate);
}

}  // namespace lcs::tools
