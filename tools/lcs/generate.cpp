#include "tools/lcs/generate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <thread>

#include "scenarios/load.h"
#include "scenarios/scenes.h"
#include "sim/simulation.h"
#include "tools/app/version.h"
#include "tools/bench/detector.h"
#include "tools/files/csv.h"
#include "tools/files/output.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/progress.h"
#include "tools/lcs/terminal.h"
#include "tools/recording/warnings.h"
#include "tools/sequence/generator.h"
#include "tools/sequence/manifest.h"
#include "tools/sequence/writer.h"
#include "tools/suite/child_process.h"
#include "tools/suite/shard.h"

namespace lcs::tools {
namespace {

constexpr const char* kHelp = R"(Examples:
  lcs generate scenarios/crossing.yaml --out data/crossing
  lcs generate scenarios/crossing.yaml --formats euroc,flow --frames 20 --seed 7 --out data/seed7
  lcs replay data/crossing                       the filter on it: the verdicts of lcs run
  lcs generate --suite --jobs 2 --out data       every short scenario: data/NAME-seedN
  lcs generate --suite --shard 3/16 --out data   the third of 16 parts, as a batch system has it
  parallel lcs generate --suite --out data --shard {}/4 ::: 1 2 3 4

Each frame is checked before it is written: flow against depth and poses, boxes against masks, IMU
against poses, times. The folder's README.md says every unit, frame and axis; manifest.json has the
hash of every file. A run that was stopped goes on where it was when it is given again, and
the bytes are those of a run that never stopped. A folder that holds anything else is refused.
With --shard i/n and one scenario only the i-th part of the frames is made; when all parts are there, the
command without it puts the sequence together.

Exit codes:
  0  fine
  2  error; what is whole stays, and the same command goes on from there
  130  interrupted (Ctrl-C): likewise
)";

namespace fs = std::filesystem;

constexpr int kMostJobs = 1024, kMostSeeds = 1000;
constexpr int kMostFrames = 100'000'000;

fs::path target_of(const GenerateOptions& options, const scenario::Scenario& scenario) {
  if (!options.out.empty()) return options.out;
  return fs::path("data") / scenario.name;
}

scenario::Scenario load(const GenerateOptions& options) {
  scenario::Scenario scenario =
      scenario::load(options.paths.front(), {.sets = options.sets, .seed = options.seed});
  sim::require_scene(scenario);
  if (options.frames > 0) scenario.frames = std::min(scenario.frames, options.frames);
  return scenario;
}

/// The requested formats in the order of the table, without duplicates.
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
    print_out("{} is complete, and every file is as its manifest says\n", folder.string());
  return kFine;
}

/// Makes the parts of one sequence in child processes, one part for each job.
/// \throws std::runtime_error if a process fails.
void share_frames(const GenerateOptions& options, const sequence::Journal& journal,
                  const std::function<void(int)>& show) {
  std::vector<std::vector<std::string>> commands;
  for (int i = 1; i <= options.jobs; ++i) {
    commands.push_back(sequence_command(options, options.paths.front(), journal.folder().string()));
    commands.back().insert(commands.back().end(),
                           {"--shard", fmt::format("{}/{}", i, options.jobs)});
  }
  int shown = 0;
  suite::run_all(
      commands, static_cast<std::size_t>(options.jobs),
      [&](std::size_t place, const suite::Exit& exit) {
        // Only the process of the last part simulates the world to its end.
        if (place + 1 == commands.size()) warn(suite::warnings_of(exit));
        if (exit.code != kFine || exit.signal != 0) {
          throw std::runtime_error(suite::complaint_of(exit));
        }
      },
      [&](const std::vector<std::size_t>&) {
        const int recorded = journal.recorded();
        while (shown < recorded) show(++shown);
        show(shown);
      });
}

/// Waits for the folder's lock, so that only one process assembles the sequence.
void wait_for_turn(const fs::path& folder, std::optional<bench::FolderLock>& turn) {
  for (bool is_told = false;; is_told = true) {
    turn.emplace(folder);
    if (!turn->is_of_another()) return;
    if (!is_told) {
      tell(fmt::format("{}: another process makes this sequence; waiting until it has ended",
                       folder.string()));
    }
    check_interrupted();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace

CLI::App& add_generate_command(CLI::App& app, GenerateOptions& options) {
  CLI::App& command = *app.add_subcommand(
      "generate", "Simulate a scenario and write it as a sequence that other tools read");
  command
      .add_option("SCENARIO", options.paths,
                  "The scenario, a YAML file; with --suite files and folders, or the project's own")
      ->type_name("");
  command.add_flag("--suite", options.suite, "A sequence for each of many scenarios");
  command
      .add_option(
          "--out", options.out,
          "Folder of the sequence, data/<scenario> if not given; with --suite the folder of all, "
          "data if not given")
      ->type_name("DIR")
      ->group(kOutputs);
  std::string about = "Formats, with commas between them; all if not given:";
  for (const sequence::Format& format : sequence::formats()) {
    about += fmt::format("\n{:<10} {}", format.name, format.purpose);
  }
  command.add_option("--formats", options.formats, about)->type_name("LIST")->delimiter(',');
  add_integer_option(command, "--frames", options.frames, "Only the first N frames", 1, kMostFrames)
      ->type_name("N");
  add_seed_option(command, options.seed);
  add_set_option(command, options.sets, "Set a value of the scenario, as \"ego.speed=0.7 m/s\"");
  add_integer_option(command, "--jobs", options.jobs,
                     "Processes at a time; they share the frames of one scenario, or the sequences",
                     1, kMostJobs)
      ->type_name("N");
  command.add_option("--shard", options.shard, "Only the i-th part of n, as 3/16")
      ->type_name("I/N");
  command.add_option("--group", options.group, "With --suite: only scenarios of this group")
      ->type_name("NAME");
  command
      .add_option("--filter", options.filter,
                  "With --suite: only scenarios with this regular expression in their name")
      ->type_name("REGEX");
  add_integer_option(command, "--seeds", options.seeds,
                     "With --suite: sequences of each scenario; 1 if not given", 1, kMostSeeds)
      ->type_name("N");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return command;
}

std::vector<std::string> sequence_command(const GenerateOptions& options,
                                          const std::string& scenario, const std::string& out) {
  std::vector<std::string> command{"generate", scenario, "--out", out, "--quiet"};
  const auto add = [&](const char* name, const std::string& value) {
    command.insert(command.end(), {name, value});
  };
  if (!options.formats.empty())
    add("--formats", fmt::format("{}", fmt::join(options.formats, ",")));
  if (options.frames > 0) add("--frames", std::to_string(options.frames));
  if (options.seed) add("--seed", std::to_string(*options.seed));
  for (const std::string& set : options.sets) add("--set", set);
  return command;
}

ExitCode generate(const GenerateOptions& options) {
  if (options.suite) return generate_suite(options);
  if (options.paths.size() != 1) {
    throw std::invalid_argument("give one scenario, or --suite; see lcs generate --help");
  }
  if (options.jobs > 1 && !options.shard.empty()) {
    throw std::invalid_argument(
        "--jobs shares the frames of a scenario, and so does --shard; give one of them");
  }
  const scenario::Scenario scenario = load(options);
  bench::filter_parameters(scenario);  // a sequence keeps them for its replay: they must be valid
  const sequence::GenerateOptions what{formats_of(options), options.sets, app::program_text()};
  const bool is_part = !options.shard.empty();
  const auto [part, parts] = is_part ? suite::shard_of(options.shard) : suite::Shard{};
  const sequence::FrameRange range = sequence::part_of(scenario.frames, part, parts);
  const std::string plan = sequence::plan_of(scenario, what);
  std::optional<bench::FolderLock> turn;
  sequence::Journal journal(target_of(options, scenario), plan, [&](const fs::path& folder) {
    if (!is_part) wait_for_turn(folder, turn);
  });
  if (journal.is_complete()) return check_complete(journal.folder(), options.quiet);

  if (options.jobs == 1) {  // otherwise the child processes print it
    warn(scenario::shadowed_files(scenario));
  }
  bench::Recording seen;  // only its warnings are used
  const int frames = range.last - range.first;
  int whole = 0;
  try {
    Progress progress(scenario.name, std::max(frames, 1), options.quiet);
    const auto show = [&](int done) {
      whole = done;
      if (done > 0) progress.show(done);
      check_interrupted();
    };
    if (options.jobs > 1) share_frames(options, journal, show);
    seen.warnings = sequence::generate_frames(scenario, what, journal, range, show);
  } catch (const Interrupted&) {
    print_err(
        "lcs: interrupted; {} of {} frames are whole, and the same command goes on from "
        "there\n",
        whole, frames);
    return kInterrupted;
  }
  warn(bench::lines_of(bench::warnings_of(seen)));
  if (is_part) {
    if (!options.quiet) {
      print_out(
          "{}: frames {} to {} are whole; when all parts are, the same command without "
          "--shard puts the sequence together\n",
          scenario.name, range.first, range.last - 1);
    }
    return kFine;
  }
  const std::vector<std::string> notes = sequence::finish_sequence(scenario, what, plan, journal);
  if (!options.quiet) {
    print_out("{}: {} frames, seed {}\n", scenario.name, scenario.frames, scenario.seed);
    for (const std::string& note : notes) print_out("  {}\n", note);
    print_out("  files    {}\n", journal.folder().string());
  }
  return kFine;
}

}  // namespace lcs::tools
