/// \file
/// `lcs score`: computes a run's figures from its files, for its own or another detector.
#include <fmt/format.h>

#include "scenarios/input/message.h"
#include "tools/app/score.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"
#include "tools/output/table.h"
#include "tools/suite/tables.h"

namespace lcs::tools {
namespace {

using ScoreOptions = Quietable<app::ScoreRequest>;

constexpr const char* kScoreHelp = R"(Examples:
  lcs score out/crossing                                    the figures of a run
  lcs score out/suite                                       the figures of all runs of a suite
  lcs score out/crossing --detections mine.csv              another detector on the same frames
  lcs score out/crossing --detections mine.csv --out mine.json
  lcs score out/crossing --write-detections lcs.csv         what the run's detector said, as CSV

A row of detections is one of these; corners that no row names are normal
(tools/recording/DETECTIONS.md has all of it, and how to write them from Python):
  FRAME,rebel,X,Y                        or normal, pending, ignored; or FRAME,rebel,INDEX
  FRAME,box,ID,LEFT,TOP,WIDTH,HEIGHT     an object, in pixels
  FRAME,mask,ID,HEIGHT,WIDTH,COUNTS      the same by COCO's RLE
  FRAME,circle,X,Y,RADIUS                a group of rebels, by which false objects are counted;
                                         without values: there is none in this frame

The command reads layers.jsonl (corners), truth.jsonl and frames.csv (times) of the run's folder, and
changes nothing there. tools/scoring/SCORING.md defines the figures. Figures of time and size exist for
the run's own detector only.

Exit codes:
  0  fine
  2  error, with file, line, problem and remedy; nothing was written
)";

ExitCode score(const ScoreOptions& options) {
  Terminal terminal(options.quiet);
  const auto [run, frames, metrics, suite] = app::score(options.request, terminal);
  if (options.quiet) return kFine;
  if (suite) {
    print_out("{}", suite::suite_table(*suite, false));
  } else {
    print_out("{}\n{}",
              input::one_line(fmt::format("{} by {}: {} frames, seed {}", run.scenario,
                                          run.detector.name, frames, run.seed)),
              output::table(metrics));
  }
  return kFine;
}

}  // namespace

Command score_command() {
  return command_of("Score a run by its files, or someone else's detector on the same frames",
                    kScoreHelp, &score);
}

}  // namespace lcs::tools
