#include "tools/app/generate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "scenarios/load.h"
#include "scenarios/scenes.h"
#include "sim/simulation.h"
#include "tools/app/how_made.h"
#include "tools/bench/detector.h"
#include "tools/files/output.h"
#include "tools/recording/warnings.h"
#include "tools/sequence/writer.h"
#include "tools/suite/child_process.h"
#include "tools/suite/parts.h"
#include "tools/suite/plan.h"

namespace lcs::app {
namespace {

scenario::Scenario load(const GenerateRequest& request) {
  scenario::Scenario scenario =
      scenario::load(request.paths.front(), {.sets = request.sets, .seed = request.seed});
  sim::require_scene(scenario);
  if (request.frames > 0) scenario.frames = std::min(scenario.frames, request.frames);
  return scenario;
}

/// The requested formats and those to which they are added, in the order of the table, without
/// duplicates.
std::vector<std::string> formats_of(const GenerateRequest& request,
                                    const std::vector<std::string>& earlier) {
  for (const std::string& name : request.formats) sequence::format(name);
  std::vector<std::string> names;
  for (const sequence::Format& format : sequence::formats()) {
    const bool is_asked = request.formats.empty()
                              ? format.is_usual
                              : std::ranges::count(request.formats, format.name) > 0;
    if (is_asked || std::ranges::count(earlier, format.name) > 0) names.emplace_back(format.name);
  }
  return names;
}

std::string megabytes(double bytes) {
  return fmt::format("{:.{}f} MB", bytes / 1e6, bytes < 1e7 ? 1 : 0);
}

/// Tells the size of a sequence, or of the formats that are added to one, before it is made.
/// \throws files::OutputError if the disk has too little room for it.
void tell_size(const scenario::Scenario& scenario, const std::vector<std::string>& formats,
               const std::vector<std::string>& earlier, sequence::SequenceFolder& folder,
               Caller& caller) {
  double bytes = sequence::estimated_bytes(scenario, formats);
  if (!earlier.empty()) bytes -= sequence::estimated_bytes(scenario, earlier);
  caller.note(fmt::format("{}: {} frames with {}: about {}{}", scenario.name, scenario.frames,
                          fmt::join(formats, ", "), megabytes(bytes),
                          earlier.empty() ? "" : " more"));
  bytes *= 1 - 1.0 * folder.recorded() / scenario.frames;
  const auto free = static_cast<double>(fs::space(folder.staging()).available);
  if (bytes <= free) return;
  throw files::OutputError(
      fmt::format("{}: the sequence takes about {}, and its disk has {} free; make room, or choose "
                  "fewer --formats, fewer --frames or another folder with --out",
                  folder.target().string(), megabytes(bytes), megabytes(free)));
}

/// The arguments of a child process that makes one sequence or a part of it.
std::vector<std::string> sequence_command(const GenerateRequest& request,
                                          const std::string& scenario, const std::string& out) {
  GenerateRequest one;
  one.paths = {scenario};
  one.out = out;
  one.formats = request.formats;
  one.add = request.add;
  one.frames = request.frames;
  one.seed = request.seed;
  one.sets = request.sets;
  std::vector<std::string> words = arguments_of(one);
  words.emplace_back("--quiet");
  return words;
}

/// Makes the parts of one sequence in child processes, one part for each job.
/// \throws std::runtime_error if a process fails.
void share_frames(const GenerateRequest& request, sequence::SequenceFolder& folder,
                  const std::function<void(int)>& show, Caller& caller) {
  std::vector<std::vector<std::string>> commands;
  for (int i = 1; i <= request.jobs; ++i) {
    commands.push_back(sequence_command(request, request.paths.front(), folder.target().string()));
    commands.back().insert(commands.back().end(),
                           {"--shard", fmt::format("{}/{}", i, request.jobs)});
  }
  int shown = 0;
  suite::run_all(
      commands, static_cast<std::size_t>(request.jobs),
      [&](std::size_t place, const suite::Exit& exit) {
        // Only the process of the last part simulates the world to its end.
        if (place + 1 == commands.size()) caller.warn(suite::warnings_of(exit));
        if (!exit.is_fine()) throw std::runtime_error(suite::complaint_of(exit));
      },
      [&](const std::vector<std::size_t>&) {
        const int recorded = folder.recorded();
        while (shown < recorded) show(++shown);
        show(shown);
      });
}

/// Called again and again while another process makes the sequence.
std::function<void()> waiting(const fs::path& target, Caller& caller) {
  return [&caller, target, is_told = false]() mutable {
    if (!std::exchange(is_told, true)) {
      caller.tell(fmt::format("{}: another process makes this sequence; waiting until it has ended",
                              target.string()));
    }
    caller.check();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  };
}

/// Makes the frames of a part, or of the whole sequence and with it the files of all frames.
void make(const GenerateRequest& request, const sequence::GenerateOptions& what,
          sequence::SequenceFolder& folder, Generated& made, Caller& caller) {
  const scenario::Scenario& scenario = made.scenario;
  const int frames = made.range.last - made.range.first;
  int whole = 0;
  sim::Warnings world;
  try {
    const auto progress = caller.progress(scenario.name, std::max(frames, 1), "frames");
    const auto show = [&](int done) {
      whole = done;
      if (done > 0) progress->show(done);
      caller.check();
    };
    if (request.jobs > 1) share_frames(request, folder, show, caller);
    world = sequence::generate_frames(scenario, what, folder, made.range, show);
  } catch (const Interrupted&) {
    throw Interrupted(fmt::format(
        "interrupted; {} of {} frames are whole, and the same command goes on from there", whole,
        frames));
  }
  caller.warn(recording::lines_of(recording::WarningWatch(recording::Truth::all).warned(world)));
  made.state = request.shard.empty() ? Generated::State::whole : Generated::State::part;
  if (request.shard.empty()) made.notes = sequence::finish_sequence(scenario, what, folder);
}

// The sequences of a suite: makes every sequence in its own process.

struct PlannedSequences {
  std::vector<std::string> names;  ///< of their folders
  std::vector<std::vector<std::string>> commands;
};

/// Draws the worlds of a shard. \return their scenario files.
std::vector<fs::path> draw_part(const GenerateRequest& request, const suite::Shard& shard,
                                Caller& caller) {
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
  std::vector<fs::path> paths(request.paths.begin(), request.paths.end());
  if (!request.worlds.split.empty()) {
    paths = draw_part(request, shard, caller);
    shard = {};
  }
  const fs::path folder = place_of(request.out, "data");
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

Generated generate(const GenerateRequest& request, Caller& caller) {
  if (request.paths.size() != 1) {
    throw std::invalid_argument("give one scenario, --suite or --worlds; see lcs generate --help");
  }
  if (request.jobs > 1 && !request.shard.empty()) {
    throw std::invalid_argument(
        "--jobs shares the frames of a scenario, and so does --shard; give one of them");
  }
  Generated made{.folder = {}, .range = {}, .notes = {}, .scenario = load(request)};
  const scenario::Scenario& scenario = made.scenario;
  bench::filter_parameters(scenario);  // a sequence keeps them for its replay: they must be valid
  const bool is_part = !request.shard.empty();
  const auto [part, parts] = is_part ? suite::shard_of(request.shard) : suite::Shard{};
  made.range = sequence::part_of(scenario.frames, part, parts);
  sequence::GenerateOptions what{formats_of(request, {}), request.sets, {}};
  add_program(what.program, {});
  add_changed_program(what.program);
  const fs::path target = place_of(request.out, fs::path("data") / scenario.name);
  // The paths in a sequence's provenance are relative to the folder of the scenario.
  const fs::path base = fs::absolute(scenario.file).lexically_normal().parent_path();
  sequence::SequenceFolder folder(target, base, request.add, is_part, waiting(target, caller));
  made.folder = folder.target();
  std::vector<std::string> earlier;
  if (request.add) earlier = folder.formats();
  what.formats = formats_of(request, earlier);
  if (folder.is_complete(sequence::facts_of(scenario, what))) {
    made.state = Generated::State::complete_before;
    return made;
  }
  tell_size(scenario, what.formats, earlier, folder, caller);
  if (request.jobs == 1) {  // otherwise the child processes print it
    caller.warn(scenario::shadowed_files(scenario));
  }
  make(request, what, folder, made, caller);
  return made;
}

SequencesMade generate_suite(const GenerateRequest& request, Caller& caller) {
  SequencesMade made;
  const PlannedSequences sequences = plan_sequences(request, made, caller);
  // A folder that cannot be made is told once, not by each sequence.
  fs::create_directories(place_of(request.out, "data"));
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
