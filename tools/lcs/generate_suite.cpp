// `lcs generate --suite`: makes every sequence in its own process.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "tools/lcs/generate.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/terminal.h"
#include "tools/suite/child_process.h"
#include "tools/suite/plan.h"
#include "tools/suite/shard.h"

namespace lcs::tools {
namespace {

struct PlannedSequence {
  std::string name;  ///< name of its folder
  std::vector<std::string> command;
};

/// The sequences of this shard. Reports broken scenarios on stderr and sets `is_broken`.
std::vector<PlannedSequence> plan_sequences(const GenerateOptions& options, bool& is_broken) {
  const auto [part, parts] =
      options.shard.empty() ? suite::Shard{} : suite::shard_of(options.shard);
  const std::filesystem::path folder = options.out.empty() ? "data" : options.out;
  std::vector<PlannedSequence> mine;
  std::size_t place = 0;
  for (const suite::PlannedScenario& planned :
       suite::plan({.paths = {options.paths.begin(), options.paths.end()},
       .group = options.group,
       .filter = options.filter,
       .sets = options.sets,
       .seeds = options.seeds})) {
    if (!planned.scenario) {
      tell("error: " + planned.error);
      is_broken = true;
      continue;
    }
    for (const std::uint64_t seed : planned.seeds) {
      // Round robin balances the shards: neighbouring sequences have similar lengths.
      if (static_cast<int>(place++ % static_cast<std::size_t>(parts)) != part - 1) continue;
      GenerateOptions one = options;
      one.sets = planned.sets;
      one.seed = seed;
      const std::string name = fmt::format("{}-seed{}", planned.name, seed);
      mine.push_back(
          {name, sequence_command(one, planned.file.string(), (folder / name).string())});
    }
  }
  return mine;
}

}  // namespace

ExitCode generate_suite(const GenerateOptions& options) {
  bool is_broken = false;
  const std::vector<PlannedSequence> sequences = plan_sequences(options, is_broken);
  std::vector<std::vector<std::string>> commands;
  for (const PlannedSequence& sequence : sequences) commands.push_back(sequence.command);
  std::size_t done = 0;
  try {
    suite::run_all(
        commands, static_cast<std::size_t>(options.jobs),
        [&](std::size_t place, const suite::Exit& exit) {
          ++done;
          const std::string& name = sequences[place].name;
          for (const std::string& line : suite::warnings_of(exit)) {
            tell(fmt::format("warning: {}: {}", name, line));
          }
          if (exit.code != kFine || exit.signal != 0) {
            tell(fmt::format("error: {}: {}", name, suite::complaint_of(exit)));
            is_broken = true;
          } else if (!options.quiet) {
            tell(fmt::format("[{}/{}] {}: {:.1f} s", done, sequences.size(), name, exit.wall_s));
          }
        },
        [&](const std::vector<std::size_t>&) { check_interrupted(); });
  } catch (const Interrupted&) {
    print_err(
        "lcs: interrupted; {} of {} sequences are whole, and the same command goes on from "
        "there\n",
        done, sequences.size());
    return kInterrupted;
  }
  return is_broken ? kError : kFine;
}

}  // namespace lcs::tools
