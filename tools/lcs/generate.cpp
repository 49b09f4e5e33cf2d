#include "tools/lcs/generate.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scenarios/load.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/progress.h"
#include "tools/lcs/version.h"
#include "tools/sequence/generator.h"
#include "tools/sequence/manifest.h"
#include "tools/sequence/writer.h"

namespace lcs::tools {
namespace {

constexpr const char* kHelp = R"(Examples:
  lcs generate scenarios/crossing.yaml --out data/crossing
  lcs generate scenarios/crossing.yaml --formats euroc,flow --frames 20 --seed 7 --out data/seed7
  lcs replay data/crossing                       the filter on it: the verdicts of lcs run

Each frame is checked before it is written: flow against depth and poses, boxes against masks, IMU
against poses, times. The folder's README.md says every unit, frame and axis; manifest.json has the
hash of every file. A run that was stopped goes on where it was when it is given again, and
the bytes are those of a run that never stopped. A folder that holds anything else is refused.

Exit codes:
  0  fine
  2  error; what is whole stays, and the same command goes on from there
  130  interrupted (Ctrl-C): likewise
)";

namespace fs = std::filesystem;

fs::path target_of(const GenerateOptions& options, const scenario::Scenario& scenario) {
  if (!options.out.empty()) return options.out;
  return fs::path("data") / scenario.name;
}

scenario::Scenario load(const GenerateOptions& options) {
  scenario::Scenario scenario =
      scenario::load(options.scenario, {.sets = options.sets, .seed = options.seed});
  if (options.frames > 0) scenario.frames = std::min(scenario.frames, options.frames);
  return scenario;
}

/// In the order of the table, each once.
std::vector<std::string> formats_of(const GenerateOptions& options) {
  for (const std::string& name : options.formats) sequence::format(name);
  std::vector<std::string> names;
  for (const sequence::Format& format : sequence::formats()) {
    const bool is_asked = std::count(options.formats.begin(), options.formats.end(), format.name);
    if (options.formats.empty() || is_asked) names.emplace_back(format.name);
  }
  return names;
}

ExitCode check_complete(const fs::path& folder, bool quiet) {
  const std::vector<std::string> damaged = sequence::damage(folder);
  if (!damaged.empty()) {
    throw std::runtime_error(fmt::format(
        "{}: {}{}; remove the folder to make it anew", folder.string(), damaged.front(),
        damaged.size() > 1 ? fmt::format(", and {} more files", damaged.size() - 1) : ""));
  }
  if (!quiet)
    fmt::print("{} is complete, and every file is as its manifest says\n", folder.string());
  return kFine;
}

}  // namespace

CLI::App& add_generate_command(CLI::App& app, GenerateOptions& options) {
  CLI::App& command = *app.add_subcommand(
      "generate", "Simulate a scenario and write it as a sequence that other tools read");
  command.add_option("SCENARIO", options.scenario, "The scenario, a YAML file")
      ->required()
      ->type_name("");
  command.add_option("--out", options.out, "Folder of the sequence; data/<scenario> if not given")
      ->type_name("DIR");
  std::string about = "Formats, with commas between them; all if not given:";
  for (const sequence::Format& format : sequence::formats()) {
    about += fmt::format("\n{:<10} {}", format.name, format.purpose);
  }
  command.add_option("--formats", options.formats, about)->type_name("LIST")->delimiter(',');
  command.add_option("--frames", options.frames, "Only the first N frames")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command.add_option("--seed", options.seed, "Seed, instead of the scenario's")->type_name("N");
  command
      .add_option("--set", options.sets,
                  "Set a value of the scenario, as \"ego.speed=0.7 m/s\"; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_flag("--quiet", options.quiet, "Print nothing but what went wrong");
  command.footer(kHelp);
  return command;
}

ExitCode generate(const GenerateOptions& options) {
  const InterruptGuard interrupt;
  const scenario::Scenario scenario = load(options);
  const sequence::GenerateOptions what{formats_of(options), options.sets, program_text()};
  const std::string plan = sequence::plan_of(scenario, what);
  sequence::Journal journal(target_of(options, scenario), plan);
  if (journal.is_complete()) return check_complete(journal.folder(), options.quiet);

  int whole = 0;
  try {
    Progress progress(scenario.name, scenario.frames, options.quiet);
    sequence::generate_frames(scenario, what, journal, {0, scenario.frames}, [&](int done) {
      whole = done;
      if (done > 0) progress.show(done);
      interrupt.check();
    });
  } catch (const Interrupted&) {
    fmt::print(stderr,
               "lcs: interrupted; {} of {} frames are whole, and the same command goes on from "
               "there\n",
               whole, scenario.frames);
    return kInterrupted;
  }
  const std::vector<std::string> notes = sequence::finish_sequence(scenario, what, plan, journal);
  if (!options.quiet) {
    fmt::print("{}: {} frames, seed {}\n", scenario.name, scenario.frames, scenario.seed);
    for (const std::string& note : notes) fmt::print("  {}\n", note);
    fmt::print("  files    {}\n", journal.folder().string());
  }
  return kFine;
}

}  // namespace lcs::tools
