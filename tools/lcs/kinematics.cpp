/// \file
/// `lcs kinematics`: the conditions under which the kinematics model holds for a camera and rover.
#include <memory>

#include "tools/app/kinematics.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/options.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

struct KinematicsOptions {
  app::KinematicsRequest request;
  bool quiet = false;
};

constexpr const char* kHelp = R"(Examples:
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

constexpr input::Quantity kTolerance{input::Dimension::pixels, {0, 1000, true}};

ExitCode kinematics(const KinematicsOptions& options) {
  Terminal terminal(options.quiet);
  const app::KinematicsMade made = app::kinematics(options.request, terminal);
  if (!options.quiet) print_out("{}\nresults in {}\n", made.text, made.folder.string());
  return kFine;
}

}  // namespace

Command add_kinematics_command(CLI::App& app) {
  const auto owned = std::make_shared<KinematicsOptions>();
  KinematicsOptions& options = *owned;
  CLI::App& command = *app.add_subcommand(
      "kinematics",
      "Measure when the motion model holds for a camera and rover, against the truth");
  command
      .add_option(
          "--config", options.request.config,
          "Scenario file with the camera, rover and IMU; scenarios/crossing.yaml if not given")
      ->type_name("FILE");
  add_set_option(command, options.request.sets,
                 "Set a value of the scenario, as \"camera.fovy=90 deg\"");
  add_out_option(command, options.request.out, "out/kinematics");
  add_quantity_option(command, "--tolerance", kTolerance, options.request.tolerance_px,
                      "Largest acceptable error of a prediction; 1 px if not given")
      ->type_name("PX");
  command.add_flag("--quick", options.request.quick,
                   "Fewer frames and seeds: a quarter of the time");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return {command, [owned] { return kinematics(*owned); }};
}

}  // namespace lcs::tools
