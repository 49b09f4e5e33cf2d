#include "tools/lcs/replay.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "filter/detect/fast.h"
#include "filter/filter.h"
#include "tools/bench/picture_folder.h"
#include "tools/bench/result.h"
#include "tools/bench/timed.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/progress.h"

namespace lcs::tools {
namespace {

constexpr const char* kHelp =
    R"(Example, a robot that drives ahead at 3 cm/s and takes a picture a second:
  lcs replay --images pictures --fps 1 --speed 0.03 --focal 600

The camera looks where the robot drives and does not turn; the principal point is the middle of the
picture. Pictures are taken by the number in their names. Those that cannot be read, or are of another
size, are named and skipped; their time passes.

Files are those of `lcs run`; without a truth, what is scored by it is null in metrics.json.
)";

Parameters parameters_of(const ReplayOptions& options) {
  Parameters parameters = preset(options.preset);
  for (const std::string& setting : options.sets) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw std::invalid_argument(
          fmt::format("--set takes KEY=VALUE, as circle.mu_0=20, not '{}'", setting));
    }
    set(parameters, setting.substr(0, equals), setting.substr(equals + 1));
  }
  return parameters;
}

void check(const ReplayOptions& options) {
  const auto positive = [](const char* name, double value) {
    if (std::isfinite(value) && value > 0) return;
    throw std::invalid_argument(fmt::format("--{} is {}; it must be above 0", name, value));
  };
  positive("fps", options.fps);
  positive("focal", options.focal_px);
  if (!std::isfinite(options.speed_mps)) {
    throw std::invalid_argument("--speed must be a number of m/s");
  }
}

std::filesystem::path target_of(const ReplayOptions& options) {
  if (!options.out.empty()) return options.out;
  // A trailing slash leaves an empty last part.
  const auto folder = std::filesystem::absolute(options.images).lexically_normal();
  return std::filesystem::path("out") /
         (folder.has_filename() ? folder.filename() : folder.parent_path().filename());
}

EgoMotion straight_ahead(double speed_mps, double dt_s) {
  EgoMotion motion;
  motion.dt_s = dt_s;
  motion.v_C_mps = {0, 0, speed_mps};
  return motion;
}

void print_result(const bench::Recording& recording, const bench::Metrics& metrics,
                  const bench::PictureFolder& pictures, const std::filesystem::path& target) {
  using Figure = std::optional<double>;
  const auto get = [&](const char* name) { return bench::value(metrics, name); };
  const auto number = [](Figure figure, int decimals) {
    return figure ? fmt::format("{:.{}f}", *figure, decimals) : "-";
  };
  const Figure size = get("dimension.mean"), store = get("dimension.five_frame_mean");
  const Figure share = size && store && *store > 0 ? Figure(*size / *store) : std::nullopt;
  fmt::print("{}: {} pictures, {} skipped\n", recording.scenario, recording.frames.size(),
             pictures.skipped().size());
  fmt::print("  corners  {} a picture\n", number(get("dimension.corners_mean"), 0));
  fmt::print("  edges    {} of the normal ones are matched again in the next picture\n",
             number(get("edges.rematched"), 2));
  fmt::print("  size     {} items: {} of a store of the last 5 pictures' corners\n",
             number(size, 0), number(share, 2));
  fmt::print("  time     {} ms a picture; cv::FAST {}\n", number(get("time.filter_ms_median"), 2),
             number(get("time.detect_ms_median"), 2));
  fmt::print("  files    {}\n", target.string());
}

}  // namespace

CLI::App& add_replay_command(CLI::App& app, ReplayOptions& options) {
  CLI::App& command = *app.add_subcommand("replay", "Run the LCS filter on a folder of pictures");
  command.add_option("--images", options.images, "Folder of pictures")
      ->required()
      ->type_name("DIR");
  command.add_option("--fps", options.fps, "Pictures a second")->required()->type_name("HZ");
  command.add_option("--speed", options.speed_mps, "Of the camera, ahead, in m/s")
      ->required()
      ->type_name("M/S");
  command.add_option("--focal", options.focal_px, "Focal length in pixels")
      ->required()
      ->type_name("PX");
  command
      .add_option("--fast-threshold", options.fast_threshold,
                  "Contrast of a corner, 1 to 254 grey levels; 20 if not given")
      ->type_name("N");
  command
      .add_option("--preset", options.preset,
                  "Parameters of the filter: default, or the paper's lab or cars")
      ->type_name("NAME");
  command
      .add_option("--set", options.sets,
                  "Set a parameter of the filter, as circle.mu_0=20; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--out", options.out, "Folder for the results; out/<folder> if not given")
      ->type_name("DIR");
  command.add_flag("--no-video", options.no_video, "Write no video.mp4");
  command.add_flag("--quiet", options.quiet,
                   "Print neither progress nor figures, only what went wrong");
  command.footer(kHelp);
  return command;
}

ExitCode replay(const ReplayOptions& options) {
  const InterruptGuard interrupt;
  check(options);
  const Parameters parameters = parameters_of(options);
  const FastDetector detector(options.fast_threshold);
  bench::PictureFolder pictures(options.images);

  bench::Recording recording;
  recording.scenario = target_of(options).filename().string();
  std::optional<Filter> filter;
  std::optional<bench::Result> result;
  std::optional<std::size_t> last;
  Progress progress(recording.scenario, static_cast<int>(pictures.size()), options.quiet);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    interrupt.check();
    progress.show(static_cast<int>(i) + 1);
    const std::optional<cv::Mat3b> image = pictures.read(i);
    if (!image) {
      fmt::print(stderr, "skipped: {}\n", pictures.skipped().back());
      continue;
    }
    if (!filter) {
      const Vec2 size(image->cols, image->rows);
      filter.emplace(
          Intrinsics{options.focal_px, 0.5 * (size - Vec2(1, 1)), image->cols, image->rows},
          parameters);
      result.emplace(
          target_of(options), recording, image->size(),
          bench::ResultOptions{.video_frames_per_second =
                                   options.no_video ? std::nullopt : std::optional(options.fps)});
    }
    bench::FrameRecord& frame = recording.frames.emplace_back();
    frame.index = static_cast<int>(recording.frames.size()) - 1;
    frame.t_ns = std::llround(static_cast<double>(i) * 1e9 / options.fps);
    if (last) {
      const double dt_s = static_cast<double>(i - *last) / options.fps;
      frame.motion = straight_ahead(options.speed_mps, dt_s);
    }
    last = i;

    cv::Mat1b grey;
    cv::cvtColor(*image, grey, cv::COLOR_BGR2GRAY);
    bench::FrameTimes times;
    frame.corners_px = bench::timed(times.detect_ms, [&] { return detector.detect(grey); });
    const FrameResult& said = bench::timed(times.filter_ms, [&]() -> const FrameResult& {
      return filter->step(frame.corners_px, frame.motion);
    });
    frame.verdicts = said.verdicts;
    frame.reasons = said.reasons;
    frame.layers = said.layers;
    times.line_ms = said.times.line_ms;
    times.circle_ms = said.times.circle_ms;
    times.square_ms = said.times.square_ms;
    frame.times = times;
    frame.corner_truth.resize(frame.corners_px.size());  // none is known
    result->add(frame, *image);
  }
  if (!result) {
    throw std::runtime_error(fmt::format("none of the pictures in {} can be read", options.images));
  }
  const bench::Metrics metrics = result->finish(recording);
  if (!options.quiet) print_result(recording, metrics, pictures, result->target());
  return kFine;
}

}  // namespace lcs::tools
