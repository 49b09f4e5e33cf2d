/// \file
/// `lcs replay`: runs a detector on a recording that options describe instead of a scenario file.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "tools/app/replay.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/detector_option.h"
#include "tools/lcs/options.h"
#include "tools/lcs/run.h"
#include "tools/lcs/terminal.h"
#include "tools/replay/recorded.h"

namespace lcs::tools {
namespace {

struct ReplayOptions {
  app::ReplayRequest request;
  std::string write;  ///< scenario file to write instead of running; "": run
  bool force = false;
  bool quiet = false;
};

using app::flag_of;
using app::kNothingMoves;

constexpr const char* kHelp =
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

Files are those of `lcs run`. Without a truth, figures that need one are null in metrics.json. A sequence of
lcs generate that has truth.jsonl (--formats landmarks, or all) is scored as its run.
)";

/// An option that is a key of `recording`. The scenario loader checks its value.
struct KeyOption {
  const char* key;
  const char* type;  ///< commas denote a list
  const char* about;
};
constexpr KeyOption kKeys[] = {
    {"camera", "NAME", "Name of the camera, if the layout has several, as cam1 (EuRoC)"},
    {"topics.image", "TOPIC", "Of a ROS bag: its pictures; without it the topics are listed"},
    {"topics.camera_info", "TOPIC", "Of a ROS bag: the calibration, if not beside the pictures"},
    {"topics.imu", "TOPIC", "Of a ROS bag: an IMU"},
    {"topics.poses", "TOPIC", "Of a ROS bag: poses, in place of the IMU"},
    {"topics.odometry", "TOPIC", "Of a ROS bag: velocities beside the IMU"},
    {"topics.world", "FRAME", "Of a ROS bag: the frame of poses that come from tf"},
    {"fps", "HZ", "Pictures a second, if the recording has no times"},
    {"times", "FILE", "When the pictures were taken: a time a line, or a table with their names"},
    {"time_unit", "UNIT", "Of times in tables and names of pictures: s, ms, us or ns"},
    {"every", "N", "Take every N-th picture only"},
    {"poses", "FILE",
     "Poses of the camera: lines of TUM (t x y z qx qy qz qw) or KITTI (12 numbers), or a table"},
    {"imu", "FILE",
     "Readings of an IMU, a table with a header as EuRoC's, ROS's or a phone's; where pictures "
     "have "
     "no clock the first one belongs to the first picture, --speed is the speed then"},
    {"odometry", "FILE", "Velocities by the wheels, in addition to --imu, CSV as EuRoC's"},
    {"speed", "M/S", "Of the camera, ahead, in m/s; 0 where it stands"},
    {"at_rest", "S", "Seconds at the start in which the camera stands"},
    {"calibration", "FILE",
     "Of the camera: YAML of Kalibr, OpenCV, ROS (camera_info), ORB-SLAM3, VINS or OpenVINS"},
    {"imu_calibration", "FILE", "Noise of the IMU, as Kalibr's imu.yaml has it"},
    {"focal", "PX", "Focal length in pixels"},
    {"centre", "X,Y", "Principal point in pixels, as 319.5,239.5; the middle if not given"},
    {"distortion", "K1,K2,P1,P2,K3", "Of the lens, as OpenCV has it"},
    {"equidistant", "K1,K2,K3,K4", "Distortion of a fisheye, as OpenCV has it"},
    {"camera_height", "M", "Of the camera above the ground, in m"},
    {"mount", "R,P,Y",
     "Where the camera looks: roll, pitch (down), yaw (left) from straight ahead, in degrees"},
    {"bayer", "PATTERN", "Raw pictures: rggb, bggr, grbg or gbrg, from the top left pixel on"},
    {"bits", "N", "Used bits of 16-bit pictures; if not given, judged by their values"},
    {"mask", "FILE", "A picture of the camera's size, white where the vehicle itself is seen"},
    {"labels", "FILE",
     "Boxes of all that moves: MOTChallenge's gt.txt, COCO's JSON, KITTI tracking's labels"},
    {"labels_video", "NAME", "The video of these labels, where their file has several"},
    {"split", "NAME", "Split that it belongs to: train, validate or test"},
};

ExitCode replay(const ReplayOptions& options) {
  if (!options.write.empty()) {
    app::write_scenario(options.request, options.write, overwrite(options.force));
    return kFine;
  }
  Terminal terminal(options.quiet);
  return show_run(app::replay(options.request, terminal), options.quiet);
}

}  // namespace

Command add_replay_command(CLI::App& app) {
  const auto owned = std::make_shared<ReplayOptions>();
  ReplayOptions& options = *owned;
  CLI::App& command =
      *app.add_subcommand("replay", "Run the LCS filter (or a comparator) on a recording");
  command
      .add_option("--images,PATH", options.request.path,
                  "The recording: a folder, a video, or a ROS bag")
      ->required()
      ->type_name("");
  std::string about = "Layout of the recording; if not given, recognized by its files:";
  for (const replay::Layout& layout : replay::layouts()) {
    about += fmt::format("\n{:<14} {}", layout.name, layout.purpose);
  }
  const auto add_key = [&](const std::string& key, const std::string& what) {
    return command.add_option_function<std::string>(
        flag_of(key),
        [&options, key](const std::string& text) { options.request.recording[key] = text; }, what);
  };
  add_key("format", about)->type_name("NAME");
  for (const KeyOption& key : kKeys) add_key(key.key, key.about)->type_name(key.type);
  command.add_flag_callback(
      "--nothing-moves", [&options] { options.request.recording[kNothingMoves] = "true"; },
      "Nothing but the camera moves: every rebel is false");
  command
      .add_option("--ego-motion", options.request.ego_motion,
                  "imu: by dead reckoning; truth: by the recording's own truth")
      ->type_name("SOURCE");
  command
      .add_option("--corners", options.request.corners,
                  "pictures: FAST's; events: those of an event camera. If not given, pictures")
      ->type_name("SOURCE");
  command
      .add_option("--fast-threshold", options.request.fast_threshold,
                  "Contrast of a corner, 1 to 254 grey levels; auto: by the noise and the "
                  "compression of each picture. If not given, auto or the recording's")
      ->type_name("N|auto");
  add_detector_option(command, options.request.detector, kPresetDetector);
  command
      .add_option("--preset", options.request.preset,
                  "Parameters of the filter: default, or the paper's lab or cars")
      ->type_name("NAME");
  add_set_option(command, options.request.sets,
                 "Set a parameter of the filter, as hypotheses.prior=0.05");
  add_beside_option(command, options.request.beside);
  add_out_option(command, options.request.out, "out/<recording>");
  add_output_file_option(command, "--write", options.write, options.force,
                         "Write the scenario that the options make to this file, and run nothing");
  add_result_options(command, options.request.no_video, options.request.events);
  add_threads_option(command, options.request.threads);
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return {command, [owned] { return replay(*owned); }};
}

}  // namespace lcs::tools
