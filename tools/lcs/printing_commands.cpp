/// \file
/// The commands that call one function of tools/app and print one text: `lcs kinematics`, `lcs
/// score`, `lcs tune` and `lcs world`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenarios/input/message.h"
#include "scenes/worlds/worlds.h"
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

constexpr const char* kKinematicsHelp = R"(Examples:
  lcs kinematics                                    the camera and rover of scenarios/crossing.yaml
  lcs kinematics --config my_rover.yaml --out out/mine
  lcs kinematics --set "camera.fovy=90 deg" --set "ego.speed=2 m/s" --set imu.preset=tumvi
  lcs kinematics --quick                            a quarter of the time, noisier figures
  lcs kinematics --tolerance 0.5                    does every part hold within half a pixel?

The file is a scenario. The command uses its camera (size, fovy, rate, mount), the rover's speed, IMU,
odometry, scene, and the filter's field.* parameters. Three models of the rotation (the paper's as
printed, first order, homography), each with V by a reference depth, by the landmark's own motion, and by
the true depth, are compared with the truth: on points of pure geometry, on rendered corners, and along
drives. tools/kinematics/README.md describes each figure.

--quick takes fewer frames and seeds: 15 frames a drive instead of 40, 5 and 25 seeds of noise instead
of 20 and 300. Figures without noise are the same.

Files written to the folder, all or none:
  run.json           how it was made: command, program, versions, date
  answer.txt         the printed text
  answer.csv         its figures, beside those that theory expects
  kinematics.html    the answer and plots; open it in a browser
  rotation.csv, translation.csv, foe_distance.csv, focal_length.csv, mount.csv, drives.csv, imu.csv,
  bumps.csv, drift.csv
                     all figures of each experiment

Exit codes:
  0  fine
  2  error: nothing was written, an earlier result is as it was
  130  interrupted (Ctrl-C): likewise
)";

std::string kinematics(const app::KinematicsRequest& request, app::Caller& caller) {
  const app::KinematicsMade made = app::kinematics(request, caller);
  return fmt::format("{}\nresults in {}\n", made.text, made.folder.string());
}

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

std::string score(const app::ScoreRequest& request, app::Caller& caller) {
  const auto [run, frames, metrics, suite] = app::score(request, caller);
  if (suite) return suite::suite_table(*suite, false);
  return fmt::format("{}\n{}",
                     input::one_line(fmt::format("{} by {}: {} frames, seed {}", run.scenario,
                                                 run.detector.name, frames, run.seed)),
                     output::table(metrics));
}

constexpr const char* kTuneHelp = R"(Examples:
  lcs suite --worlds train --count 200 --out out/train
  lcs suite --worlds validate --count 160 --out out/validate
  lcs tune out/train --validate out/validate              all learnt numbers
  lcs suite my_recordings --out out/recorded; lcs tune out/train out/recorded
  lcs tune out/train --keys hypotheses.prior,hypotheses.newcomer --evaluations 60
  lcs tune out/train --evaluations 1                      the objective of the present numbers
  lcs tune out/train --evaluations 1 --set hypotheses.prior=0.05

The filter runs on the frames of the suites again and again, each time with other numbers, on all cores.
The objective is the mean F1 of rebels over the worlds in which something moves, less a tenth of the mean
number of false objects in a frame (at most one a world), and less a hundredth of the false corners in a
frame of recordings in which nothing moves. NLopt's BOBYQA maximizes it between a quarter of the present
values and four times these. Runs of the split test are refused: nothing is chosen by them. A run
records its world, so it is recognized under any name, with any seed, in another scenario and as a
sequence of lcs generate.

Each evaluation is kept at once, also if the program is killed. The same command continues an interrupted
search, or one with more evaluations, and gives the same numbers. The journal records everything that its
figures depend on: the program, the files of the runs, the suites' names, the settings, the seed, each
number with its start and bounds. If any of these differs, or a row was edited, the command refuses the
journal; remove it then, or name another folder.

Files in the folder:
  evaluations.csv    the journal: every set that was tried, with its figures
  learnt.h           the best of them, for filter/types/learnt.h: the preset default takes them from there
  record.md          the suites before and after, the numbers, the command, the program

Exit codes:
  0  fine
  2  error
  130  interrupted (Ctrl-C): the evaluations so far are kept
)";

std::string tune(const app::TuneRequest& request, app::Caller& caller) {
  const app::TuneMade made = app::tune(request, caller);
  return fmt::format("{}\nresults in {}\n", made.record, made.folder.string());
}

constexpr const char* kWorldHelp = R"(Examples:
  lcs world room --seed 7 --out my/room          my/room/room_7.yaml and its scene
  lcs run my/room/room_7.yaml                    as any other scenario
  lcs world street --pictures ~/photos           surfaces from a folder of pictures
  lcs suite --worlds test --count 60             many of them at once

The same seed gives the same bytes. Seeds 1 to 999999 are of the split `train`, the next million of
`validate`, and the million after of `test`, by which nothing is chosen (scenes/worlds/README.md).

Files written to the folder, all or none:
  FAMILY_SEED.yaml   the scenario, with a summary in its first lines
  scene.xml          the scene in MJCF, which MuJoCo's own viewer opens too
  textures/, meshes/ PNG and OBJ files
  plan.png           the world from above: fixed objects, the way of the rover (blue), of the movers (magenta)
  sheet.png          with --sheet: first, middle and last picture with the truth's boxes, and the plan

Exit codes:
  0  fine
  2  error, or the folder holds anything else than a world that lcs wrote; nothing was written
  130  interrupted (Ctrl-C): likewise
)";

std::string world(const app::WorldRequest& request, app::Caller& caller) {
  const auto [drawn, folder] = app::world(request, caller);
  return fmt::format(
      "{}: {} objects, {} movers, drawn again {} times\n  has      {}\n  files    {}\n",
      worlds::name_of(drawn), drawn.bodies.size(), drawn.scenario.actors.size(), drawn.attempt,
      fmt::join(drawn.features, ", "), folder.string());
}

}  // namespace

Command kinematics_command() {
  return command_of("Measure when the motion model holds for a camera and rover, against the truth",
                    kKinematicsHelp, &print<app::KinematicsRequest, kinematics>);
}

Command score_command() {
  return command_of("Score a run by its files, or someone else's detector on the same frames",
                    kScoreHelp, &print<app::ScoreRequest, score>);
}

Command tune_command() {
  return command_of("Learn the filter's numbers from recorded runs", kTuneHelp,
                    &print<app::TuneRequest, tune>);
}

Command world_command() {
  return command_of("Draw a scenario and its scene from a seed, and write them", kWorldHelp,
                    &print<app::WorldRequest, world>);
}

}  // namespace lcs::tools
