/// \file
/// `lcs run`: simulates a scenario, runs a detector on its frames, scores it and reports.
#include "scenarios/keys.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"
#include "tools/lcs/view.h"
#include "tools/output/table.h"
#include "tools/scoring/metrics.h"

namespace lcs::tools {
namespace {

struct RunOptions {
  app::RunRequest request;
  bool keys = false;  ///< print the keys of a scenario file in place of a run
  bool view = false;  ///< show the run in a window
  bool quiet = false;
};

constexpr const char* kRunHelp = R"(Examples:
  lcs run scenarios/crossing.yaml
  lcs run scenarios/crossing.yaml --seed 7 --out out/seed7
  lcs run scenarios/lab.yaml --set "ego.speed=10 cm/s" --set filter.hypotheses.prior=0.05
  lcs run scenarios/crossing.yaml --detector klt --out out/crossing-klt
  lcs run scenarios/crossing.yaml --detector mine --detector-command 'python3 mine.py'
                                     a detector of yours, in any language (tools/comparators/PROTOCOL.md)
  lcs run scenarios/crossing.yaml --view                 watch it in a window while it runs
  lcs run my_drive.yaml              recorded frames in place of a scene (scenarios/README.md)
  lcs run scenarios/crossing.yaml --beside klt=out/crossing-klt     both on the same frames, made once
  lcs run scenarios/crossing.yaml --set filter.hypotheses.prior=0.05 --recorded out/crossing --no-video
                                     the changed filter on the frames of an earlier run, in a second

Files written to the folder, all or none:
  metrics.json   every figure, flat; null where it is not defined (tools/scoring/SCORING.md)
  frames.csv     a row a frame: sizes of all layers, precision, recall, times
  layers.jsonl   a line a frame: corners, verdicts, every layer
  truth.jsonl    a line a frame: the truth of every corner and object
  detector.json  the detector's name
  camera.json    the camera, as detectors get it
  run.json       how it was made: command, program, settings, seed, versions, date
  warnings.json  problems: the rover or an actor ran into something, fell, tipped over
  video.mp4      the paper's four panels: corners, edges, circles, squares
  events.json    with --events or --report: the worst misses and false alarms, with the rules that decided,
                 and JPEG pictures
  report.html    with --report: a page for the browser, with the video beside the plots
  pictures.mjpeg with --events: the pictures of the camera, compressed, for --recorded

Problems of the data (readings of the sensors, times, corners) are counted and printed on stderr, and so are
problems of the world, each with its first time and place.

Exit codes:
  0  fine
  1  a required criterion of the scenario is not met
  2  error: nothing was written, an earlier result is as it was
  130  interrupted (Ctrl-C): likewise
)";

void print_result(const scenario::Scenario& scenario, const std::string& detector,
                  const scoring::Metrics& metrics, std::optional<int> skipped,
                  const std::filesystem::path& folder) {
  const std::string by = detector == "lcs" ? "" : fmt::format(" by {}", detector);
  const double frames = scoring::value(metrics, "frames").value_or(0);
  const std::string what = skipped ? fmt::format("{:.0f} pictures, {} skipped", frames, *skipped)
                                   : fmt::format("{:.0f} frames, seed {}", frames, scenario.seed);
  const scoring::Metric& speed = scoring::metric("sim.frames_per_second");
  print_out("{}{}: {}, {} {}\n", scenario.name, by, what,
            speed.number(scoring::value(metrics, speed.key).value_or(0)), speed.scale.unit);
  print_out("{}  files    {}\n", output::table(metrics), folder.string());
}

/// Prints a line for each missed criterion on stderr. \return whether a required one is missed.
bool report_missed(const std::vector<scoring::JudgedCriterion>& criteria) {
  bool failed = false;
  for (const scoring::JudgedCriterion& one : criteria) {
    if (one.met) continue;
    tell(fmt::format("{}: {}", one.required ? "failed" : "missed (not required)", one.message));
    failed |= one.required;
  }
  return failed;
}

ExitCode run(const RunOptions& options) {
  Terminal terminal(options.quiet);
  app::RunRequest request = options.request;
  request.scenario = scenario_file(request.scenario).string();
  std::shared_ptr<View> view;
  if (options.view) {
    request.view = [&](const scenario::Scenario& scenario) {
      view = std::make_shared<View>(scenario.name, scenario.camera.rate_hz);
      return [view](const cv::Mat3b& sheet) { return view->show(sheet); };
    };
  }
  const ExitCode code = show_run(app::run(request, terminal), options.quiet);
  if (view) view->hold();
  return code;
}

app::Options options_of(RunOptions& options) {
  app::Options all = app::options_of(options.request);
  all.add("--keys", "", &options.keys,
          "Print every key of a scenario file: meaning, default, values",
          {.prints = scenario::keys_text});
  all.add("--view", "", &options.view,
          "Show the four panels in a window while it runs, no faster than the camera: space pauses "
          "and goes on, . goes on by one frame, q closes it; the last frame stays until a key is "
          "pressed");
  all.add_quiet(options.quiet);
  return all;
}

}  // namespace

ExitCode show_run(const app::RunMade& made, bool quiet) {
  if (!quiet) {
    for (const app::DetectorMade& one : made.detectors) {
      print_result(made.scenario, one.name, one.metrics, made.pictures_skipped, one.folder);
    }
  }
  bool failed = false;
  for (const app::DetectorMade& one : made.detectors) failed |= report_missed(one.criteria);
  return failed ? kCriterionFailed : kFine;
}

Command run_command() {
  return command_of(
      "Simulate a scenario, or read its recording, run the LCS filter (or a comparator) on it, and "
      "score it by the truth",
      kRunHelp, &run);
}

}  // namespace lcs::tools
