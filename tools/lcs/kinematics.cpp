/// \file
/// `lcs kinematics`: the conditions under which the kinematics model holds for a camera and rover.

#include "tools/app/kinematics.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

using KinematicsOptions = Quietable<app::KinematicsRequest>;

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

ExitCode kinematics(const KinematicsOptions& options) {
  Terminal terminal(options.quiet);
  const app::KinematicsMade made = app::kinematics(options.request, terminal);
  if (!options.quiet) print_out("{}\nresults in {}\n", made.text, made.folder.string());
  return kFine;
}

}  // namespace

Command kinematics_command() {
  return command_of("Measure when the motion model holds for a camera and rover, against the truth",
                    kKinematicsHelp, &kinematics);
}

}  // namespace lcs::tools
