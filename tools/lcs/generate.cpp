/// \file
/// `lcs generate`: writes scenarios as sequences of pictures and truth for other tools.
#include "tools/app/generate.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

using GenerateFlags = Quietable<app::GenerateRequest>;

constexpr const char* kGenerateHelp = R"(Examples:
  lcs generate scenarios/crossing.yaml --out data/crossing
  lcs generate scenarios/crossing.yaml --formats euroc,flow --frames 20 --seed 7 --out data/seed7
  lcs generate scenarios/crossing.yaml --for flow --out data/flow         formats by their use
  lcs generate scenarios/crossing.yaml --formats coco --out data/crossing --add      one more format
  lcs replay data/crossing                       the filter on it: the verdicts of lcs run
  lcs generate --suite --jobs 2 --out data       every short scenario: data/NAME-seedN
  lcs generate --suite --shard 3/16 --out data   the third of 16 parts, as a batch system has it
  lcs generate --worlds train --count 100 --out data       worlds drawn from seeds: data/NAME-seedN
  parallel lcs generate --suite --out data --shard {}/4 ::: 1 2 3 4

Each frame is checked before it is written: flow against depth and poses, boxes against masks, IMU
against poses, times. The size is told before the first frame is made, to a factor of two; a disk with
less room is refused. A sequence that fails at its start leaves nothing. The folder's README.md says every unit, frame and axis; manifest.json has the
hash of every file. A run that was stopped goes on where it was when it is given again, and
the bytes are the same as of a run that never stopped. A folder that holds anything else is refused.
With --shard i/n and one scenario only the i-th part of the frames is made; when all parts are there, the
command without it puts the sequence together.

Exit codes:
  0  fine
  2  error; what is whole stays, and the same command goes on from there
  130  interrupted (Ctrl-C): likewise
)";

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
