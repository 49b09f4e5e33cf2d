// The sequences of a suite: makes every sequence in its own process.
#include <fmt/format.h>

#include <stdexcept>

#include "tools/app/generate.h"
#include "tools/suite/child_process.h"
#include "tools/suite/parts.h"
#include "tools/suite/plan.h"

namespace lcs::app {
namespace {

struct PlannedSequences {
  std::vector<std::string> names;  ///< of their folders
  std::vector<std::vector<std::string>> commands;
};

/// Draws the worlds of a shard. \return their scenario files.
std::vector<std::filesystem::path> draw_part(const GenerateRequest& request,
                                             const suite::Shard& shard, Caller& caller) {
  std::vector<worlds::Kept> chosen = chosen_worlds(request.worlds, request.filter);
  if (static_cast<std::size_t>(shard.parts) > chosen.size()) {
    throw std::invalid_argument(fmt::format(
        "--shard {}: there are only {} worlds; make fewer parts", request.shard, chosen.size()));
  }
  int place = 0;
  std::erase_if(chosen, [&](const auto&) { return place++ % shard.parts != shard.part - 1; });
  return draw_worlds(chosen, jobs_at_once(request.jobs), caller);
}

/// The sequences of this shard. Adds an error for each broken scenario.
PlannedSequences plan_sequences(const GenerateRequest& request, SequencesMade& made,
                                Caller& caller) {
  suite::Shard shard = request.shard.empty() ? suite::Shard{} : suite::shard_of(request.shard);
  std::vector<std::filesystem::path> paths(request.paths.begin(), request.paths.end());
  if (!request.worlds.split.empty()) {
    paths = draw_part(request, shard, caller);
    shard = {};
  }
  const std::filesystem::path folder = place_of(request.out, "data");
  PlannedSequences mine;
  std::size_t place = 0;
  for (const suite::PlannedScenario& planned : suite::plan({.paths = paths,
                                               .group = request.group,
                                               .filter = request.filter,
                                               .sets = request.sets,
                                               .seeds = request.seeds})) {
    if (!planned.scenario) {
      caller.tell("error: " + planned.error);
      made.errors.push_back(planned.error);
      continue;
    }
    for (const std::uint64_t seed : planned.seeds) {
      // Round robin balances the shards: neighbouring sequences have similar lengths.
      if (static_cast<int>(place++ % static_cast<std::size_t>(shard.parts)) != shard.part - 1)
        continue;
      GenerateRequest one = request;
      one.sets = planned.sets;
      one.seed = seed;
      mine.names.push_back(fmt::format("{}-seed{}", planned.name, seed));
      made.folders.push_back(folder / mine.names.back());
      mine.commands.push_back(
          sequence_command(one, planned.file.string(), made.folders.back().string()));
    }
  }
  return mine;
}

}  // namespace

SequencesMade generate_suite(const GenerateRequest& request, Caller& caller) {
  SequencesMade made;
  const PlannedSequences sequences = plan_sequences(request, made, caller);
  // A folder that cannot be made is told once, not by each sequence.
  std::filesystem::create_directories(place_of(request.out, "data"));
  const std::size_t total = sequences.names.size();
  std::size_t done = 0;
  try {
    suite::run_all(
        sequences.commands, static_cast<std::size_t>(request.jobs),
        [&](std::size_t place, const suite::Exit& exit) {
          ++done;
          const std::string& name = sequences.names[place];
          for (const std::string& line : suite::warnings_of(exit)) {
            caller.warn({fmt::format("{}: {}", name, line)});
          }
          if (exit.is_fine()) {
            caller.note(fmt::format("[{}/{}] {}: {:.1f} s", done, total, name, exit.wall_s));
          } else {
            made.errors.push_back(fmt::format("{}: {}", name, suite::complaint_of(exit)));
            caller.tell("error: " + made.errors.back());
          }
        },
        [&](const std::vector<std::size_t>&) { caller.check(); });
  } catch (const Interrupted&) {
    throw Interrupted(fmt::format(
        "interrupted; {} of {} sequences are whole, and the same command goes on from there", done,
        total));
  }
  return made;
}

}  // namespace lcs::app
