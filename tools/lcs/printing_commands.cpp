/// \file
/// The commands that call one function of tools/app and print one text: `lcs generate`, `lcs
/// kinematics`, `lcs score`, `lcs tune` and `lcs world`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenarios/input/message.h"
#include "scenes/worlds/worlds.h"
#include "tools/app/generate.h"
#include "tools/app/kinematics.h"
#include "tools/app/score.h"
#include "tools/app/tune.h"
#include "tools/app/world.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"
#include "tools/output/table.h"
#include "tools/suite/tables.h"

namespace lcs::tools {
namespace {

/// Prints the text that the function returns, unless the command is quiet.
template <class Request, std::string (*text_of)(const Request&, app::Caller&)>
ExitCode print(const Quietable<Request>& options) {
  Terminal terminal(options.quiet);
  const std::string text = text_of(options.request, terminal);
  if (!options.quiet) print_out("{}", text);
  return kFine;
}

std::string kinematics(const app::KinematicsRequest& request, app::Caller& caller) {
  const app::KinematicsMade made = app::kinematics(request, caller);
  return fmt::format("{}\nresults in {}\n", made.text, made.folder.string());
}

struct ScoreOptions : Quietable<app::ScoreRequest> {
  scoring::Format format = {};
};

std::string text_of(const app::Scored& scored, scoring::Format format) {
  const auto& [run, frames, metrics, suite] = scored;
  if (suite) return suite::suite_table(*suite, false, format);
  if (format != scoring::Format::text) {
    return table_text(output::figure_table({{run.detector.name, metrics}}), format);
  }
  return fmt::format("{}\n{}",
                     input::one_line(fmt::format("{} by {}: {} frames, seed {}", run.scenario,
                                                 run.detector.name, frames, run.seed)),
                     output::table(metrics));
}

ExitCode score(const ScoreOptions& options) {
  Terminal terminal(options.quiet);
  const app::Scored scored = app::score(options.request, terminal);
  if (!options.quiet) print_out("{}", text_of(scored, options.format));
  return kFine;
}

app::Options options_of(ScoreOptions& options) {
  app::Options all = options_of<app::ScoreRequest>(options);
  add_format(all, options.format);
  return all;
}

std::string tune(const app::TuneRequest& request, app::Caller& caller) {
  const app::TuneMade made = app::tune(request, caller);
  return fmt::format("{}\nresults in {}\n", made.record, made.folder.string());
}

std::string world(const app::WorldRequest& request, app::Caller& caller) {
  const auto [drawn, folder] = app::world(request, caller);
  return fmt::format(
      "{}: {} objects, {} movers, drawn again {} times\n  has      {}\n  files    {}\n",
      worlds::name_of(drawn), drawn.bodies.size(), drawn.scenario.actors.size(), drawn.attempt,
      fmt::join(drawn.features, ", "), folder.string());
}

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

Command kinematics_command() {
  return command_of("Measure when the motion model holds for a camera and rover, against the truth",
                    kKinematicsHelp, &print<app::KinematicsRequest, kinematics>);
}

Command score_command() {
  return command_of("Score a run by its files, or someone else's detector on the same frames",
                    kScoreHelp, &score);
}

Command tune_command() {
  return command_of("Learn the filter's numbers from recorded runs", kTuneHelp,
                    &print<app::TuneRequest, tune>);
}

Command world_command() {
  return command_of("Draw a scenario and its scene from a seed, and write them", kWorldHelp,
                    &print<app::WorldRequest, world>);
}

Command generate_command() {
  return command_of("Simulate a scenario and write it as a sequence that other tools read",
                    kGenerateHelp, &generate);
}

}  // namespace lcs::tools
