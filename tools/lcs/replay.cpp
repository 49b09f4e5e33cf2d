/// \file
/// `lcs replay`: runs a detector on a recording that options describe instead of a scenario file.
#include <string>

#include "tools/app/replay.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

struct ReplayOptions {
  app::ReplayRequest request;
  std::string write;  ///< scenario file to write instead of running; "": run
  bool force = false;
  bool quiet = false;
};

constexpr const char* kReplayHelp =
    R"(Examples:
  lcs replay data/crossing                        a sequence of lcs generate: the verdicts of lcs run
  lcs replay MH_01_easy                           EuRoC: motion by its IMU, from the start of its truth
  lcs replay MH_01_easy --ego-motion truth        likewise, motion by its truth
  lcs replay 2011_09_26_drive_0005_sync           KITTI raw: motion by its navigation unit
  lcs replay sequences/00 --camera-height 1.65    KITTI odometry, with the ground
  lcs replay freiburg1_xyz --focal 517            TUM RGB-D
  lcs replay 2014-05-19-13-20-57 --focal 983      RobotCar: likewise, raw pictures in colour
  lcs replay road.mp4 --speed 0 --focal 700       a video of a camera that stands
  lcs replay drive.mcap                           a ROS bag: lists its topics
  lcs replay drive.mcap --image-topic /cam/image_raw --imu-topic /imu     and reads them
  lcs replay drive.mp4 --times frames.csv --imu imu.csv --calibration camchain-imucam.yaml
  lcs replay pictures --fps 1 --speed 0.03 --focal 600       pictures of a robot that drives ahead
  lcs replay pictures --fps 10 --imu imu.csv --focal 600     likewise, with an IMU (columns as EuRoC's)
  lcs replay pictures --poses poses.txt --focal 600 --write mine.yaml
                                                  a scenario of it, for lcs run and lcs suite

This makes a scenario whose frames are recorded, and runs it: each option up to --split is a key of its
`recording` (scenarios/README.md, tools/replay/README.md). Data that are broken, of another size or
present twice are left out, data out of order are sorted, and all of it is counted and reported. Time
passes over a picture that is left out.

Writes the files of `lcs run`. Without a truth, figures that need one are null in metrics.json. A sequence of
lcs generate that has truth.jsonl (--formats landmarks, or all) is scored as its run.
)";

ExitCode replay(const ReplayOptions& options) {
  if (!options.write.empty()) {
    app::write_scenario(options.request, options.write, files::overwrite(options.force));
    return kFine;
  }
  Terminal terminal(options.quiet);
  return show_run(app::replay(options.request, terminal), options.quiet);
}

app::Options options_of(ReplayOptions& options) {
  app::Options all = app::options_of(options.request);
  all.add("--write", "FILE", &options.write,
          "Write the scenario that the options make to this file, and run nothing",
          {.is_output = true});
  all.add_force(options.force);
  all.add_quiet(options.quiet);
  return all;
}

}  // namespace

Command replay_command() {
  return command_of("Run the LCS filter (or a comparator) on a recording", kReplayHelp, &replay);
}

}  // namespace lcs::tools
