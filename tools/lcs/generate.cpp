/// \file
/// `lcs generate`: writes scenarios as sequences of pictures and truth for other tools.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "tools/app/generate.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/options.h"
#include "tools/lcs/terminal.h"
#include "tools/lcs/worlds_option.h"
#include "tools/sequence/writer.h"

namespace lcs::tools {
namespace {

struct GenerateOptions {
  app::GenerateRequest request;
  bool quiet = false;
};

constexpr const char* kHelp = R"(Examples:
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
the bytes are those of a run that never stopped. A folder that holds anything else is refused.
With --shard i/n and one scenario only the i-th part of the frames is made; when all parts are there, the
command without it puts the sequence together.

Exit codes:
  0  fine
  2  error; what is whole stays, and the same command goes on from there
  130  interrupted (Ctrl-C): likewise
)";

constexpr int kMostJobs = 1024, kMostSeeds = 1000;
constexpr int kMostFrames = 100'000'000;

ExitCode generate(const GenerateOptions& options) {
  Terminal terminal(options.quiet);
  if (options.request.is_of_many()) {
    return app::generate_suite(options.request, terminal).errors.empty() ? kFine : kError;
  }
  app::GenerateRequest request = options.request;
  request.paths.front() = scenario_file(request.paths.front()).string();
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

Command add_generate_command(CLI::App& app) {
  const auto owned = std::make_shared<GenerateOptions>();
  GenerateOptions& options = *owned;
  CLI::App& command = *app.add_subcommand(
      "generate", "Simulate a scenario and write it as a sequence that other tools read");
  command
      .add_option("SCENARIO", options.request.paths,
                  "The scenario, a YAML file; with --suite files and folders, or the project's own")
      ->type_name("");
  command.add_flag("--suite", options.request.suite, "A sequence for each of many scenarios");
  add_worlds_options(command, options.request.worlds)->excludes("SCENARIO");
  command
      .add_option(
          "--out", options.request.out,
          "Folder of the sequence, data/<scenario> if not given; with --suite the folder of all, "
          "data if not given")
      ->type_name("DIR")
      ->group(kOutputs);
  std::string about = "Formats, with commas between them; if not given, all but those with a *:";
  for (const sequence::Format& format : sequence::formats()) {
    about += fmt::format("\n{:<10} {}{}", format.name, format.purpose, format.is_usual ? "" : " *");
  }
  CLI::Option* formats = command.add_option("--formats", options.request.formats, about)
                             ->type_name("LIST")
                             ->delimiter(',');
  about = "The formats of a use, in place of --formats:";
  std::vector<std::string> uses;
  for (const sequence::Use& use : sequence::uses()) {
    about += fmt::format("\n{:<10} {}", use.name, fmt::join(use.formats, ", "));
    uses.emplace_back(use.name);
  }
  command
      .add_option_function<std::string>(
          "--for",
          [&options, uses](const std::string& name) {
            options.request.formats =
                sequence::uses()[input::as_choice(option_value("--for", name), "the use", uses)]
                    .formats;
          },
          about)
      ->type_name("USE")
      ->excludes(formats);
  command.add_flag("--add", options.request.add,
                   "Add the formats to the finished sequence in --out, which the same scenario, "
                   "seed and program made; files that are there stay as they are");
  add_integer_option(command, "--frames", options.request.frames, "Only the first N frames", 1,
                     kMostFrames)
      ->type_name("N");
  add_seed_option(command, options.request.seed);
  add_set_option(command, options.request.sets,
                 "Set a value of the scenario, as \"ego.speed=0.7 m/s\"");
  add_integer_option(command, "--jobs", options.request.jobs,
                     "Processes at a time; they share the frames of one scenario, or the sequences",
                     1, kMostJobs)
      ->type_name("N");
  command.add_option("--shard", options.request.shard, "Only the i-th part of n, as 3/16")
      ->type_name("I/N");
  command
      .add_option("--group", options.request.group, "With --suite: only scenarios of this group")
      ->type_name("NAME");
  command
      .add_option("--filter", options.request.filter,
                  "With --suite: only scenarios with this regular expression in their name")
      ->type_name("REGEX");
  add_integer_option(command, "--seeds", options.request.seeds,
                     "With --suite: sequences of each scenario; 1 if not given", 1, kMostSeeds)
      ->type_name("N");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return {command, [owned] { return generate(*owned); }};
}

}  // namespace lcs::tools
