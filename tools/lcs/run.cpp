#include "tools/lcs/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <vector>

#include "scenarios/load.h"
#include "scenarios/scenes.h"
#include "sim/simulation.h"
#include "tools/bench/bench.h"
#include "tools/bench/detector.h"
#include "tools/bench/earlier_run.h"
#include "tools/comparators/detectors.h"
#include "tools/lcs/detector_option.h"
#include "tools/lcs/how_made.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/progress.h"
#include "tools/lcs/terminal.h"
#include "tools/lcs/version.h"
#include "tools/lcs/view.h"
#include "tools/output/result.h"
#include "tools/output/table.h"
#include "tools/recording/warnings.h"
#include "tools/replay/playback.h"
#include "tools/report/report_page.h"
#include "tools/scoring/criteria.h"
#include "tools/scoring/metrics.h"
#include "tools/suite/suite_run.h"

namespace lcs::tools {
namespace {

constexpr const char* kHelp = R"(Examples:
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
                                     the filter anew on the frames of an earlier run, in a moment

Files written to the folder, all or none:
  metrics.json   every figure, flat; null where it is not defined (tools/scoring/SCORING.md)
  frames.csv     a row a frame: sizes of all layers, precision, recall, times
  layers.jsonl   a line a frame: corners, verdicts, every layer
  truth.jsonl    a line a frame: the truth of every corner and object
  detector.json  the detector's name
  camera.json    the camera, as detectors are told of it
  run.json       how it was made: command, program, settings, seed, versions, date
  warnings.json  what should not be: the rover or an actor ran into something, fell, tipped over
  video.mp4      the paper's four panels: corners, edges, circles, squares
  events.json    with --events or --report: the worst misses and false alarms, with the rules that the corners
                 met their end by, and JPEG pictures
  report.html    with --report: all of it to look at in a browser, the video beside the plots
  pictures.mjpeg with --events: what the camera saw, compressed, for --recorded

What was wrong with the data (readings of the sensors, times, corners) is counted and told on stderr,
and what was wrong in the world, with its first time and place.

Exit codes:
  0  fine
  1  a required criterion of the scenario is not met
  2  error: nothing was written, an earlier result is as it was
  130  interrupted (Ctrl-C): likewise
)";

std::filesystem::path target_of(const RunOptions& options, const scenario::Scenario& scenario) {
  if (!options.out.empty()) return options.out;
  return std::filesystem::path("out") / scenario.name;
}

void print_result(const scenario::Scenario& scenario, const std::string& detector,
                  const bench::Metrics& metrics, const replay::Playback* playback,
                  const std::filesystem::path& folder) {
  const std::string by = detector == "lcs" ? "" : fmt::format(" by {}", detector);
  const double frames = bench::value(metrics, "frames").value_or(0);
  const std::string what =
      playback ? fmt::format("{:.0f} pictures, {} skipped", frames, playback->skipped())
               : fmt::format("{:.0f} frames, seed {}", frames, scenario.seed);
  const bench::Metric& speed = bench::metric("sim.frames_per_second");
  print_out("{}{}: {}, {} {}\n", scenario.name, by, what,
            speed.number(bench::value(metrics, speed.key).value_or(0)), speed.scale.unit);
  print_out("{}  files    {}\n", bench::table(metrics), folder.string());
}

Intrinsics camera_of(const scenario::Scenario& scenario) {
  return bench::intrinsics(sim::lens_of(scenario.camera).pinhole());
}

/// The source of the frames that the detectors process.
struct Frames {
  Intrinsics camera;
  bench::Recording recording;                 ///< without frames
  sim::Versions versions = {};                ///< empty if nothing is simulated
  const bench::Recording* earlier = nullptr;  ///< the earlier run's recording; null: none
  const bench::FramePictures* pictures = nullptr;
  std::vector<std::string> missing = {};  ///< warnings about data that the earlier run lacks
  std::function<std::vector<Diagnostics>(std::span<const bench::Watcher>)> run;
};

Frames simulated(const scenario::Scenario& scenario) {
  const auto simulation = std::make_shared<sim::Simulation>(scenario);
  return {.camera = bench::intrinsics(simulation->calibration().camera),
          .recording = bench::begin_recording(scenario, *simulation),
          .versions = simulation->versions(),
          .run = [&scenario, simulation](std::span<const bench::Watcher> watchers) {
            return bench::run(scenario, *simulation, watchers);
          }};
}

Frames played(const scenario::Scenario& scenario, replay::Playback& playback) {
  return {.camera = bench::intrinsics(playback.camera()),
          .recording = playback.begin(),
          .run = [&scenario, &playback](std::span<const bench::Watcher> watchers) {
            return bench::run(playback, FastDetector(scenario.fast_threshold), watchers);
          }};
}

Frames recorded(const RunOptions& options, const scenario::Scenario& scenario,
                const Intrinsics& camera) {
  const auto earlier = std::make_shared<bench::EarlierRun>(options.recorded, scenario, camera);
  const bool is_program = !options.detector.command.empty();
  const bool with_images = !options.no_video || options.view || is_program;
  if (is_program && !earlier->pictures()) {
    throw std::invalid_argument(
        fmt::format("{} has no pictures to hand to {}; record it with --events", options.recorded,
                    spec_of(options.detector).name));
  }
  if (with_images && !earlier->pictures()) {
    throw std::invalid_argument(
        fmt::format("{} has no pictures to make a video of; give --no-video without --view, or "
                    "record it with --events",
                    options.recorded));
  }
  std::vector<std::string> missing;
  if (earlier->lacks_signatures()) {
    missing.push_back(
        fmt::format("{} has no signatures of its corners, so that the filter goes by their places "
                    "alone; leave out --recorded to have them made",
                    options.recorded));
  }
  if (earlier->lacks_gaps()) {
    missing.push_back(fmt::format(
        "{} does not say what the filter saw below circles, so that bodies that approach "
        "at constant speed are not found; leave out --recorded to have it looked at",
        options.recorded));
  }
  return {.camera = camera,
          .recording = earlier->begin(),
          .earlier = &earlier->recording(),
          .pictures = earlier->pictures(),
          .missing = std::move(missing),
          .run = [earlier, with_images](std::span<const bench::Watcher> watchers) {
            std::vector<Diagnostics> all;
            for (const bench::Watcher& watcher : watchers) {
              all.push_back(
                  earlier->run(watcher.detector, watcher.recording, with_images, watcher.sink));
            }
            return all;
          }};
}

/// A detector of this run and the destination of its results.
struct Watching {
  comparators::DetectorSpec spec;
  std::filesystem::path target;
  scenario::Scenario scenario;  ///< with this detector's preset applied
  std::vector<std::string> settings_without_effect = {};
  std::unique_ptr<bench::Detector> detector = {};
  bench::Recording recording = {};
  std::unique_ptr<bench::Result> result = {};
};

/// The run's own detector, then those of `--beside`.
std::vector<Watching> watching(const RunOptions& options, const scenario::Scenario& scenario) {
  std::vector<Watching> all;
  all.push_back({spec_of(options.detector), target_of(options, scenario), scenario});
  for (const std::string& beside : options.beside) {
    const std::size_t equals = beside.find('=');
    if (equals == std::string::npos || equals + 1 == beside.size()) {
      throw std::invalid_argument(fmt::format(
          "--beside {}: give a detector and the folder for its results, as klt=out/klt", beside));
    }
    all.push_back(
        {comparators::spec_of(beside.substr(0, equals)), beside.substr(equals + 1), scenario});
  }
  for (Watching& one : all) {
    // Throws if the filter's settings are wrong, also for detectors that ignore them.
    one.settings_without_effect = comparators::apply_preset(one.spec, one.scenario);
    if (!options.recorded.empty()) comparators::require_corners_suffice(one.spec);
  }
  return all;
}

/// The command that repeats the run of one of the detectors, without its place.
std::string command_of(const RunOptions& options, const scenario::Scenario& scenario,
                       const Watching& watching, bool is_own) {
  if (options.scenario.empty()) return suite::shell_line(command_line());  // lcs replay
  std::vector<std::string> command{"run", options.scenario, "--seed",
                                   std::to_string(scenario.seed)};
  const auto add = [&](const std::string& option, const std::string& value) {
    if (!value.empty()) command.insert(command.end(), {option, value});
  };
  for (const std::string& set : options.sets) add("--set", set);
  add("--frames", options.frames);
  if (watching.spec.name != "lcs") add("--detector", watching.spec.name);
  add("--recorded", options.recorded);
  if (is_own) {
    add("--detections", options.detector.detections);
    std::ranges::move(arguments_of(options.detector), std::back_inserter(command));
  }
  return suite::shell_line(command);
}

/// Writes run.json.
void write_how_made(const RunOptions& options, const scenario::Scenario& scenario,
                    const Frames& frames, const Watching& watching, bool is_own) {
  tools::write_how_made(watching.result->output().staging(),
                        command_of(options, scenario, watching, is_own), frames.versions,
                        {{"scenario", scenario.name},
                         {"seed", scenario.seed},
                         {"frames", watching.recording.frames.size()},
                         {"detector", watching.spec.name},
                         {"settings", options.sets},
                         {"recorded", options.recorded}});
}

/// Writes the report page of the run as a suite with a single run.
void write_page(const RunOptions& options, const scenario::Scenario& scenario, const Watching& own,
                const std::filesystem::path& folder, const bench::Metrics& metrics) {
  suite::RunResult run{.seed = scenario.seed,
                       .outcome = suite::Outcome::passed,
                       .command = command_of(options, scenario, own, true),
                       .error = {},
                       .metrics = metrics,
                       .criteria = {},
                       .warnings = bench::warnings_of(own.recording),
                       .folder = "."};
  suite::judge_run(bench::asked_of(own.spec.name, true, scenario.criteria), run);
  suite::SuiteResult suite{.detector = own.spec.name,
                           .sets = options.sets,
                           .version = version_line(),
                           .recorded = options.recorded,
                           .scenarios = {}};
  if (!options.frames.empty()) suite.sets.push_back("frames=" + options.frames);
  suite.scenarios.push_back({.name = scenario.name,
                             .purpose = scenario.purpose,
                             .file = options.scenario,
                             .groups = scenario.groups,
                             .point = {},
                             .runs = {run}});
  report::write_run_report(folder / report::kReportFile, {suite, folder});
}

/// Prints a line for each missed criterion on stderr. \return whether a required one is missed.
bool report_missed(const std::vector<bench::JudgedCriterion>& criteria) {
  bool failed = false;
  for (const bench::JudgedCriterion& one : criteria) {
    if (one.met) continue;
    tell(fmt::format("{}: {}", one.required ? "failed" : "missed (not required)", one.message));
    failed |= one.required;
  }
  return failed;
}

}  // namespace

CLI::App& add_run_command(CLI::App& app, RunOptions& options) {
  CLI::App& command = *app.add_subcommand(
      "run",
      "Simulate a scenario, or read its recording, run the LCS filter (or a comparator) on it, and "
      "score it by the truth");
  command.add_option("SCENARIO", options.scenario, "The scenario, a YAML file")
      ->required()
      ->type_name("");
  add_out_option(command, options.out, "out/<scenario>");
  add_seed_option(command, options.seed);
  command.add_option("--frames", options.frames, "Frames to run, instead of the scenario's")
      ->type_name("N");
  add_set_option(command, options.sets, "Set a value of the scenario, as \"ego.speed=0.7 m/s\"");
  add_detector_option(command, options.detector, kPresetDetector);
  add_beside_option(command, options.beside);
  CLI::Option* recorded =
      command
          .add_option(
              "--recorded", options.recorded,
              "Take corners, motion and truth from an earlier run of the same scenario and seed, "
              "instead of simulating")
          ->type_name("DIR");
  command
      .add_option("--detections", options.detector.detections,
                  "With --recorded: what a detector of yours has said of these frames, a CSV file "
                  "(tools/recording/DETECTIONS.md)")
      ->type_name("FILE")
      ->needs(recorded)
      ->excludes(command.get_option("--detector-command"));
  add_result_options(command, options.no_video, options.events);
  add_keep_option(command, options.keep);
  command.add_flag("--gzip", options.gzip, "Compress layers.jsonl and truth.jsonl (.gz)");
  command.add_flag("--report", options.report,
                   "Write report.html too, a page of the run with its video, and events.json");
  command.add_flag(
      "--view", options.view,
      "Show the four panels in a window while it runs, no faster than the camera: space "
      "pauses and goes on, . goes on by one frame, q closes the window");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return command;
}

ExitCode run(const RunOptions& options) {
  std::vector<std::string> sets = options.sets;
  if (!options.frames.empty()) sets.push_back("frames=" + options.frames);
  return run_scenario(options,
                      scenario::load(options.scenario, {.sets = sets, .seed = options.seed}));
}

ExitCode run_scenario(const RunOptions& options, scenario::Scenario scenario) {
  // Validate the whole request before any output is begun.
  std::optional<replay::Playback> playback;
  if (scenario.recording) scenario = playback.emplace(scenario).scenario();
  std::vector<Watching> all = watching(options, scenario);
  Watching& own = all.front();
  bench::require_known_metrics(scenario.criteria);
  const Frames frames = [&] {
    if (!options.recorded.empty()) {
      return recorded(options, scenario,
                      playback ? bench::intrinsics(playback->camera()) : camera_of(scenario));
    }
    return playback ? played(scenario, *playback) : simulated(scenario);
  }();
  std::optional<View> view;
  if (options.view) view.emplace(scenario.name, scenario.camera.rate_hz);
  for (Watching& one : all) {
    if (scenario.frames > 0) {
      note_longer(one.target, &one != &own || !options.out.empty(), "frames",
                  static_cast<std::size_t>(scenario.frames));
    }
    one.detector = comparators::make(one.spec, {.camera = frames.camera,
                                                .scenario = one.scenario,
                                                .recorded = frames.earlier,
                                                .on_wait = check_interrupted});
    one.recording = frames.recording;
    one.recording.detector = {one.spec.name, one.spec.detector.layered,
                              one.detector->gives_circles()};
    one.recording.camera = frames.camera;
  }
  for (Watching& one : all) {
    bench::ResultOptions what;
    what.keep = options.keep;
    what.compressed = options.gzip;
    what.truth_of_other = &one != &own;
    if (&one == &own) {
      if (!options.no_video) what.video_frames_per_second = scenario.camera.rate_hz;
      if (view) what.show = [&](const cv::Mat3b& sheet) { return view->show(sheet); };
      what.events = options.events || options.report;
      if (options.report) {
        what.add_page = [&](const std::filesystem::path& folder, const bench::Metrics& figures) {
          write_page(options, scenario, own, folder, figures);
        };
      }
      what.kept = frames.pictures;
    }
    one.result = std::make_unique<bench::Result>(
        one.target, one.recording, cv::Size(frames.camera.width_px, frames.camera.height_px), what);
  }
  warn(scenario::shadowed_files(scenario));
  warn(own.settings_without_effect);
  std::set<std::string> names;
  for (const Watching& one : all) names.insert(one.spec.name);
  warn(bench::not_asked(scenario.criteria, names));
  warn(bench::not_judged(scenario.criteria));
  warn(frames.missing);
  std::vector<Diagnostics> diagnostics;
  {
    Progress progress(scenario.name, scenario.frames, options.quiet);
    std::vector<bench::Watcher> watchers;
    for (Watching& one : all) {
      watchers.push_back({*one.detector, one.recording,
                          [&](const bench::FrameRecord& frame, const cv::Mat3b& image) {
                            check_interrupted();
                            one.result->add(frame, image);
                            progress.show(frame.index + 1);
                          }});
    }
    diagnostics = frames.run(watchers);
  }
  check_interrupted();
  std::vector<bench::Metrics> metrics;
  std::vector<bench::Output*> outputs;
  for (Watching& one : all) {
    metrics.push_back(one.result->finish(one.recording));
    if (&one != &own) one.result->share_truth(*own.result);
    write_how_made(options, scenario, frames, one, &one == &own);
    outputs.push_back(&one.result->output());
  }
  check_interrupted();
  bench::commit_all(outputs);

  warn(bench::lines_of(bench::warnings_of(own.recording)));
  if (playback && options.recorded.empty()) {
    for (const std::string& line : playback->told()) tell(line);
  }
  for (const std::string& line : diagnostics.front().lines()) tell(line);
  for (const std::string& line : own.detector->told()) tell(line);
  if (!options.quiet) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      print_result(scenario, all[i].spec.name, metrics[i], playback ? &*playback : nullptr,
                   all[i].result->output().target());
    }
  }
  bool failed = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto asked = bench::asked_of(all[i].spec.name, i == 0, scenario.criteria);
    failed |= report_missed(bench::judge(asked, metrics[i]));
  }
  if (view) view->hold();
  return failed ? kCriterionFailed : kFine;
}

}  // namespace lcs::tools
