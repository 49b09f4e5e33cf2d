#include "tools/lcs/replay.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "filter/detect/fast.h"
#include "tools/bench/bench.h"
#include "tools/bench/picture_folder.h"
#include "tools/bench/result.h"
#include "tools/bench/tracker.h"
#include "tools/bench/warnings.h"
#include "tools/comparators/detectors.h"
#include "tools/lcs/detector_option.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/number_option.h"
#include "tools/lcs/progress.h"
#include "tools/lcs/set_option.h"
#include "tools/lcs/terminal.h"
#include "tools/replay/recorded.h"
#include "tools/replay/rectifier.h"

namespace lcs::tools {
namespace {

constexpr const char* kHelp =
    R"(Examples:
  lcs replay data/crossing                        a sequence of lcs generate: the verdicts of lcs run
  lcs replay MH_01_easy                           EuRoC: motion by its IMU, from the start of its truth
  lcs replay MH_01_easy --ego-motion truth        likewise, motion by its truth
  lcs replay 2011_09_26_drive_0005_sync           KITTI raw: motion by its navigation unit
  lcs replay 2014-05-19-13-20-57 --focal 983      RobotCar: likewise, raw pictures in colour
  lcs replay pictures --fps 1 --speed 0.03 --focal 600       pictures of a robot that drives ahead
  lcs replay pictures --fps 10 --imu imu.csv --focal 600     likewise, with an IMU (columns as EuRoC's)

The layout is told from the folder. Pictures without calibration need --focal; the principal point
is their middle if --centre does not say. Distorted pictures are straightened first. What is missing,
broken, of another size, out of order or twice there is left out or put in order, counted and told; the
time of a picture that is left out passes.

Files are those of `lcs run`; without a truth, what is scored by it is null in metrics.json.
)";

namespace fs = std::filesystem;

constexpr scenario::Range kPositive{.low = 0, .low_open = true};

fs::path target_of(const ReplayOptions& options) {
  if (!options.out.empty()) return options.out;
  // A trailing slash leaves an empty last part.
  const auto folder = fs::absolute(options.folder).lexically_normal();
  return fs::path("out") /
         (folder.has_filename() ? folder.filename() : folder.parent_path().filename());
}

replay::ReadOptions read_options(const ReplayOptions& options) {
  replay::ReadOptions read{.folder = options.folder,
                           .camera = options.camera,
                           .fps = options.fps,
                           .speed_mps = options.speed_mps,
                           .imu = {},
                           .mount_rpy_rad = {},
                           .exact_motion = options.ego_motion == "truth"};
  if (!options.imu.empty()) read.imu = options.imu;
  if (!options.mount_rpy_rad.empty()) {
    read.mount_rpy_rad = Eigen::Vector3d::Map(options.mount_rpy_rad.data());
  }
  return read;
}

/// What the command line says of detection and filter takes the place of what the recording says.
void apply(const ReplayOptions& options, scenario::Scenario& settings) {
  if (options.fast_threshold) settings.fast_threshold = *options.fast_threshold;
  if (!options.preset.empty()) {
    settings.filter_preset = options.preset;
    settings.filter_preset_source = {"--preset " + options.preset, 0};
  }
  for (const std::string& setting : options.sets) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw std::invalid_argument(
          fmt::format("--set takes KEY=VALUE, as constellation.radius=60, not '{}'", setting));
    }
    settings.filter.push_back(
        {setting.substr(0, equals), setting.substr(equals + 1), {"--set " + setting, 0}});
  }
}

/// By the recording's calibration, or by what the user says of the camera.
replay::Lens lens_of(const ReplayOptions& options, const std::optional<replay::Lens>& recorded,
                     cv::Size size_px) {
  if (recorded && !options.focal_px) {
    const bool is_said = recorded->width_px > 0;
    if (is_said && size_px != cv::Size(recorded->width_px, recorded->height_px)) {
      throw scenario::Error(
          recorded->source,
          fmt::format("the calibration is of {} x {} pixels, and the pictures have {} x {}; give "
                      "that of these pictures, or --focal",
                      recorded->width_px, recorded->height_px, size_px.width, size_px.height));
    }
    return *recorded;
  }
  replay::Lens lens;
  lens.fu_px = lens.fv_px = *options.focal_px;
  lens.cu_px = options.centre_px.empty() ? 0.5 * (size_px.width - 1) : options.centre_px[0];
  lens.cv_px = options.centre_px.empty() ? 0.5 * (size_px.height - 1) : options.centre_px[1];
  return lens;
}

double frames_per_second(const std::vector<replay::RecordedFrame>& frames) {
  if (frames.size() < 2) return 1;
  const double span_s = static_cast<double>(frames.back().t_ns - frames.front().t_ns) * 1e-9;
  return static_cast<double>(frames.size() - 1) / span_s;
}

void print_result(const bench::Recording& recording, const bench::Metrics& metrics,
                  std::size_t skipped, const fs::path& target) {
  using Figure = std::optional<double>;
  const auto get = [&](const char* name) { return bench::value(metrics, name); };
  const auto number = [](Figure figure, int decimals) {
    return figure ? fmt::format("{:.{}f}", *figure, decimals) : "-";
  };
  const Figure size = get("dimension.mean"), store = get("dimension.five_frame_mean");
  const Figure share = size && store && *store > 0 ? Figure(*size / *store) : std::nullopt;
  print_out("{}: {} pictures, {} skipped\n", recording.scenario, recording.frames.size(), skipped);
  print_out("  corners  {} a picture\n", number(get("dimension.corners_mean"), 0));
  print_out("  edges    {} of the normal ones are matched again in the next picture\n",
            number(get("edges.rematched"), 2));
  print_out("  size     {} items: {} of a store of the last 5 pictures' corners\n", number(size, 0),
            number(share, 2));
  print_out("  time     {} ms a picture; cv::FAST {}\n", number(get("time.filter_ms_median"), 2),
            number(get("time.detect_ms_median"), 2));
  print_out("  files    {}\n", target.string());
}

}  // namespace

CLI::App& add_replay_command(CLI::App& app, ReplayOptions& options) {
  CLI::App& command =
      *app.add_subcommand("replay", "Run the LCS filter (or a comparator) on a recording");
  command.add_option("--images,DIR", options.folder, "Folder of the recording")
      ->required()
      ->type_name("");
  std::string about = "Layout of the folder; if not given, told from what it holds:";
  for (const replay::Layout& layout : replay::layouts()) {
    about += fmt::format("\n{:<9} {}", layout.name, layout.purpose);
  }
  command.add_option("--format", options.layout, about)->type_name("NAME");
  command
      .add_option("--camera", options.camera,
                  "Which camera, where the layout has several, as cam1 (EuRoC)")
      ->type_name("NAME");
  add_quantity_option(command, "--fps", {scenario::Dimension::frequency, kPositive}, options.fps,
                      "Pictures a second, where the layout does not say")
      ->type_name("HZ");
  add_quantity_option(command, "--speed", {scenario::Dimension::speed, {}}, options.speed_mps,
                      "Of the camera, ahead, in m/s")
      ->type_name("M/S");
  command
      .add_option("--imu", options.imu,
                  "Readings of an IMU for a folder of pictures, CSV as EuRoC's; the first one "
                  "belongs to the first picture, --speed is the speed then")
      ->type_name("FILE");
  add_quantity_option(command, "--focal", {scenario::Dimension::number, kPositive},
                      options.focal_px, "Focal length in pixels")
      ->type_name("PX");
  add_quantities_option(command, "--centre", {scenario::Dimension::number, {}}, 2,
                        options.centre_px, "Principal point in pixels, as 319.5,239.5")
      ->type_name("X,Y");
  add_quantities_option(command, "--mount", {scenario::Dimension::angle, {}}, 3,
                        options.mount_rpy_rad,
                        "Where the camera looks: roll, pitch (down), yaw (left) from straight "
                        "ahead, in degrees")
      ->type_name("R,P,Y");
  command
      .add_option("--ego-motion", options.ego_motion,
                  "imu: by dead reckoning; truth: by the recording's own truth")
      ->type_name("SOURCE")
      ->check(CLI::IsMember({"imu", "truth"}));
  add_detector_option(command, options.detector);
  command
      .add_option_function<std::string>(
          "--fast-threshold",
          [&options](const std::string& text) {
            options.fast_threshold =
                scenario::as_threshold(option_value("--fast-threshold", text), "the number");
          },
          "Contrast of a corner, 1 to 254 grey levels; auto: by the noise and the compression of "
          "each picture. If not given, auto or the recording's")
      ->type_name("N|auto");
  command
      .add_option("--preset", options.preset,
                  "Parameters of the filter: default, or the paper's lab or cars")
      ->type_name("NAME");
  add_set_option(command, options.sets,
                 "Set a parameter of the filter, as constellation.radius=60");
  command.add_option("--out", options.out, "Folder for the results; out/<folder> if not given")
      ->type_name("DIR");
  command.add_flag("--no-video", options.no_video, "Write no video.mp4");
  command.add_flag("--quiet", options.quiet,
                   "Print neither progress nor figures, only what went wrong");
  command.footer(kHelp);
  return command;
}

ExitCode replay(const ReplayOptions& options) {
  const comparators::Detector& watcher = comparators::detector(options.detector);
  replay::Recorded recorded =
      replay::layout_of(options.layout, options.folder).read(read_options(options));
  if (!recorded.lens && !options.focal_px) {
    throw std::invalid_argument("the recording has no calibration of its camera; give --focal");
  }
  apply(options, recorded.settings);
  // what is wrong with them is told before any output
  const std::vector<std::string> idle_settings = bench::idle_settings(recorded.settings);
  const FastDetector detector(recorded.settings.fast_threshold);
  bench::PictureReader pictures(recorded.demosaic);

  bench::Recording recording;
  recording.scenario = target_of(options).filename().string();
  recording.detector = {std::string(watcher.name), watcher.layered};
  recording.truth = bench::Truth::unknown;
  const double fps = frames_per_second(recorded.frames);
  std::optional<replay::Rectifier> rectifier;
  std::unique_ptr<bench::Tracker> tracker;
  std::optional<bench::Result> result;
  {
    Progress progress(recording.scenario, static_cast<int>(recorded.frames.size()), options.quiet);
    for (std::size_t i = 0; i < recorded.frames.size(); ++i) {
      check_interrupted();
      progress.show(static_cast<int>(i) + 1);
      std::optional<cv::Mat3b> image = pictures.read(recorded.frames[i].picture);
      if (!image) {
        tell("skipped: " + pictures.skipped().back());
        continue;
      }
      if (!rectifier) {
        rectifier.emplace(lens_of(options, recorded.lens, image->size()), image->size());
        tracker = watcher.make(rectifier->camera(), recorded.settings);
        result.emplace(
            target_of(options), recording, image->size(),
            bench::ResultOptions{.video_frames_per_second =
                                     options.no_video ? std::nullopt : std::optional(fps)});
      }
      rectifier->rectify(*image);
      bench::FrameRecord& frame = recording.frames.emplace_back();
      frame.index = static_cast<int>(recording.frames.size()) - 1;
      frame.t_ns = recorded.frames[i].t_ns;
      frame.motion = recorded.motion->at(frame.t_ns);
      bench::watch(*image, detector, *tracker, frame);
      bench::set_corner_truth(recording.truth, frame);
      result->add(frame, *image);
    }
  }
  if (!result) {
    throw std::runtime_error(
        fmt::format("none of the pictures in {} can be read; give a recording with its pictures",
                    options.folder));
  }
  const bench::Metrics metrics = result->finish(recording);
  warn(idle_settings);
  warn(bench::lines_of(bench::warnings_of(recording)));
  Diagnostics diagnostics = recorded.motion->diagnostics();
  diagnostics += tracker->diagnostics();
  diagnostics.forget(Fault::imu_gap);  // told by what read it, with its place
  for (const auto& lines : {recorded.tally.lines(), diagnostics.lines()}) {
    for (const std::string& line : lines) tell(line);
  }
  if (!options.quiet) {
    print_result(recording, metrics, pictures.skipped().size(), result->target());
  }
  return kFine;
}

}  // namespace lcs::tools
