#include "tools/app/run.h"

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <set>
#include <span>

#include "scenarios/input/inputs_read.h"
#include "scenarios/load.h"
#include "scenarios/scenes.h"
#include "sim/simulation.h"
#include "tools/app/how_made.h"
#include "tools/bench/bench.h"
#include "tools/bench/detector.h"
#include "tools/bench/earlier_run.h"
#include "tools/explain/explainer.h"
#include "tools/recording/warnings.h"
#include "tools/replay/playback.h"
#include "tools/report/report_page.h"
#include "tools/scoring/metrics.h"
#include "tools/suite/suite_run.h"

namespace lcs::app {
namespace {

/// Records the files that the words of a shell command name, such as a script. Files that a program
/// reads by itself, and programs on the PATH, are not known.
void note_files(const std::string& command) {
  std::string word;
  char quote = 0;
  const auto end_word = [&] {
    std::error_code error;
    if (std::filesystem::is_regular_file(word, error)) input::note_input(word);
    word.clear();
  };
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    if (quote != 0 ? c == quote : c == '\'' || c == '"') {
      quote = quote != 0 ? 0 : c;
    } else if (c == '\\' && quote != '\'' && i + 1 < command.size()) {
      word += command[++i];
    } else if (quote == 0 && std::strchr(" \t\n;&|<>()", c) != nullptr) {
      end_word();
    } else {
      word += c;
    }
  }
  end_word();
}

/// The source of the frames that the detectors process.
struct Frames {
  Intrinsics camera;
  recording::RunInfo info;
  int count = 0;                                    ///< number of frames; 0: unknown
  sim::Versions versions = {};                      ///< empty if nothing is simulated
  const output::FramePictures* pictures = nullptr;  ///< of an earlier run; null: none
  /// Warnings about data that the earlier run lacks, once `run` has ended.
  std::function<std::vector<std::string>()> missing = [] { return std::vector<std::string>(); };
  std::function<bench::RunEnd(std::span<const bench::DetectorRun>)> run;
};

Frames simulated(const scenario::Scenario& scenario, int threads) {
  const auto simulation = std::make_shared<sim::Simulation>(scenario);
  return {.camera = bench::intrinsics(simulation->calibration().camera),
          .info = bench::run_info(scenario, *simulation),
          .count = scenario.frames,
          .versions = simulation->versions(),
          .run = [&scenario, simulation, threads](std::span<const bench::DetectorRun> detectors) {
            return bench::run(scenario, *simulation, detectors, threads);
          }};
}

Frames played(const scenario::Scenario& scenario, replay::Playback& playback, int threads) {
  return {.camera = bench::intrinsics(playback.camera()),
          .info = playback.info(),
          .count = scenario.frames,
          .run = [&scenario, &playback, threads](std::span<const bench::DetectorRun> detectors) {
            return bench::run(playback, bench::CornerFinder(scenario), detectors, threads);
          }};
}

/// \throws std::runtime_error if a file that the earlier run has read was changed since, such as a
///   part of its scene. The scenario's own values are compared one by one (bench::EarlierRun).
void require_same_files(const RunRequest& request, const scenario::Scenario& scenario) {
  if (!std::filesystem::exists(std::filesystem::path(request.recorded) / files::kHowMadeFile)) {
    return;
  }
  files::Provenance there = files::read_how_made(request.recorded);
  std::error_code error;
  std::erase_if(there.read, [&](const auto& file) {
    return std::filesystem::equivalent(file.first, scenario.file, error) ||
           !std::filesystem::exists(file.first, error);  // it was made elsewhere
  });
  const std::string what = files::changed_since(there);
  if (what.empty()) return;
  throw std::runtime_error(
      fmt::format("{} is no recording of this run: {}; run {} without --recorded to make one",
                  request.recorded, what, scenario.name));
}

Frames recorded(const RunRequest& request, const scenario::Scenario& scenario,
                const Intrinsics& camera) {
  require_same_files(request, scenario);
  const auto earlier = std::make_shared<bench::EarlierRun>(request.recorded, scenario, camera);
  const bool is_program = !request.detector.command.empty();
  const bool with_images = request.video || request.view || is_program;
  if (is_program && !earlier->pictures()) {
    throw std::invalid_argument(
        fmt::format("{} has no pictures to hand to {}; record it with --events", request.recorded,
                    spec_of(request.detector).name));
  }
  if (with_images && !earlier->pictures()) {
    throw std::invalid_argument(
        fmt::format("{} has no pictures to make a video of; give --no-video without --view, or "
                    "record it with --events",
                    request.recorded));
  }
  const auto missing = [earlier, folder = request.recorded] {
    std::vector<std::string> lines;
    if (earlier->lacks_signatures()) {
      lines.push_back(fmt::format(
          "{} has no signatures of its corners, so that the filter goes by their places "
          "alone; leave out --recorded to have them made",
          folder));
    }
    if (earlier->lacks_gaps()) {
      lines.push_back(fmt::format(
          "{} does not say what the filter saw below circles, so that bodies that approach "
          "at constant speed are not found; leave out --recorded to have it looked at",
          folder));
    }
    return lines;
  };
  return {.camera = camera,
          .info = earlier->info(),
          .count = earlier->frames(),
          .pictures = earlier->pictures(),
          .missing = missing,
          .run = [earlier, with_images,
                  threads = request.threads](std::span<const bench::DetectorRun> detectors) {
            return earlier->run(detectors, with_images, threads);
          }};
}

/// A detector of this run and the destination of its results.
struct Watching {
  comparators::DetectorSpec spec;
  std::filesystem::path target;
  scenario::Scenario scenario;  ///< with this detector's preset applied
  std::vector<std::string> settings_without_effect = {};
  std::unique_ptr<bench::Detector> detector = {};
  recording::RunInfo info = {};
  std::unique_ptr<output::Result> result = {};
};

/// The run's own detector, then the detectors of `--beside`.
std::vector<Watching> watching(const RunRequest& request, const scenario::Scenario& scenario) {
  std::vector<Watching> all;
  const auto target = place_of(request.out, std::filesystem::path("out") / scenario.name);
  all.push_back({spec_of(request.detector), target, scenario});
  for (const std::string& beside : request.beside) {
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
    if (!request.recorded.empty()) comparators::require_corners_suffice(one.spec);
  }
  return all;
}

/// The command that repeats the run of one of the detectors, without its place.
std::string command_of(const RunRequest& request, const scenario::Scenario& scenario,
                       const Watching& watching, bool is_own) {
  if (!request.command.empty()) return suite::shell_line(request.command);
  RunRequest one{.scenario = request.scenario,
                 .seed = scenario.seed,
                 .sets = request.sets,
                 .frames = request.frames,
                 .recorded = request.recorded};
  if (is_own) one.detector = request.detector;
  one.detector.name = watching.spec.name == "lcs" ? "" : watching.spec.name;
  return suite::shell_line(arguments_of(one));
}

/// Writes run.json.
void write_how_made(const RunRequest& request, const scenario::Scenario& scenario,
                    const Frames& frames, const Watching& watching, bool is_own) {
  files::Json filter = files::Json::object();
  for (const auto& setting : watching.scenario.filter) filter[setting.key] = setting.value;
  files::Json facts{{"scenario", scenario.name},
                    {"seed", scenario.seed},
                    {"frames", watching.result->frames()},
                    {"detector", watching.spec.name},
                    {"settings", request.sets},
                    {"preset", watching.scenario.filter_preset},
                    {"filter", filter},
                    {"recorded", request.recorded}};
  add_program(facts, frames.versions);
  app::write_how_made(watching.result->output().staging(),
                      command_of(request, scenario, watching, is_own),
                      files::provenance_of(std::move(facts)));
}

/// The corners on the pictures of the run's events; null for a run that cannot be explained.
files::Json explained(const RunRequest& request, const Watching& own,
                      const std::filesystem::path& folder, Caller& caller) {
  const AnyParameters parameters = bench::filter_parameters(own.scenario);
  const bool is_plain = own.spec.detector.layered && std::holds_alternative<Parameters>(parameters);
  if (!is_plain || request.keep != output::Keep::all) return nullptr;
  const auto events = scoring::read_events(folder / scoring::kEventsFile);
  try {
    return explain::explained_views(folder, parameters, events, [&] { caller.check(); });
  } catch (const Interrupted&) {
    throw;
  } catch (const std::runtime_error& error) {  // the run itself is whole
    caller.warn({fmt::format("the report explains no corners: {}", error.what())});
    return nullptr;
  }
}

/// Writes the report page of the run as a suite with a single run.
void write_page(const RunRequest& request, const scenario::Scenario& scenario, const Watching& own,
                const std::filesystem::path& folder, const scoring::Metrics& metrics,
                Caller& caller) {
  suite::RunResult run{.seed = scenario.seed,
                       .outcome = suite::Outcome::passed,
                       .command = command_of(request, scenario, own, true),
                       .metrics = metrics,
                       .warnings = own.result->warned(),
                       .folder = "."};
  suite::judge_run(scoring::asked_of(own.spec.name, true, scenario.criteria), run);
  suite::SuiteResult suite{.detector = own.spec.name,
                           .sets = request.sets,
                           .version = version_line(),
                           .recorded = request.recorded};
  if (!request.frames.empty()) suite.sets.push_back("frames=" + request.frames);
  suite.scenarios.push_back({.name = scenario.name,
                             .purpose = scenario.purpose,
                             .file = request.scenario,
                             .groups = scenario.groups,
                             .runs = {run}});
  report::write_run_report(folder / report::kReportFile, {suite, folder},
                           explained(request, own, folder, caller));
}

/// \param playback of the scenario's recording; null: it is simulated.
Frames frames_of(const RunRequest& request, const scenario::Scenario& scenario,
                 replay::Playback* playback) {
  if (!request.recorded.empty()) {
    return recorded(
        request, scenario,
        bench::intrinsics(playback ? playback->camera() : sim::lens_of(scenario.camera).pinhole()));
  }
  return playback ? played(scenario, *playback, request.threads)
                  : simulated(scenario, request.threads);
}

void make_detectors(const RunRequest& request, const scenario::Scenario& scenario,
                    const Frames& frames, std::vector<Watching>& all, Caller& caller) {
  for (Watching& one : all) {
    if (scenario.frames > 0) {
      note_longer(one.target, &one != &all.front() || !request.out.empty(), "frames",
                  static_cast<std::size_t>(scenario.frames), caller);
    }
    one.detector = comparators::make(one.spec, {.camera = frames.camera,
                                                .scenario = one.scenario,
                                                .recorded = request.recorded,
                                                .frames = frames.count,
                                                .on_wait = [&caller] { caller.check(); }});
    one.info = frames.info;
    one.info.detector = {one.spec.name, one.spec.detector.layered, one.detector->gives_circles()};
    one.info.camera = frames.camera;
  }
}

/// Begins the outputs. The run's own detector has the pictures and the page.
void open_results(const RunRequest& request, const scenario::Scenario& scenario,
                  const Frames& frames, std::vector<Watching>& all, Caller& caller) {
  Watching& own = all.front();
  // The frames of a recording keep their truth: its file is copied if its form stays.
  const bool is_truth_there =
      !request.recorded.empty() &&
      request.gzip ==
          (recording::stored(request.recorded, recording::kTruthFile).extension() == ".gz");
  for (Watching& one : all) {
    output::ResultOptions what;
    what.keep = request.keep;
    what.compressed = request.gzip;
    what.is_truth_there = &one != &own || is_truth_there;
    if (&one == &own) {
      if (request.video) what.video_frames_per_second = scenario.camera.rate_hz;
      if (request.view) what.show = request.view(scenario);
      what.events = request.events || request.report;
      if (request.report) {
        what.add_page = [&](const std::filesystem::path& folder, const scoring::Metrics& figures) {
          write_page(request, scenario, own, folder, figures, caller);
        };
      }
      what.kept = frames.pictures;
    }
    one.result = std::make_unique<output::Result>(
        one.target, one.info, cv::Size(frames.camera.width_px, frames.camera.height_px), what);
    if (&one == &own && is_truth_there) one.result->copy_truth(request.recorded);
  }
}

void warn_before(const scenario::Scenario& scenario, const std::vector<Watching>& all,
                 Caller& caller) {
  caller.warn(scenario::shadowed_files(scenario));
  caller.warn(all.front().settings_without_effect);
  std::set<std::string> names;
  for (const Watching& one : all) names.insert(one.spec.name);
  caller.warn(scoring::not_asked(scenario.criteria, names));
  caller.warn(scoring::not_judged(scenario.criteria));
}

bench::RunEnd watch(const scenario::Scenario& scenario, const Frames& frames,
                    std::vector<Watching>& all, Caller& caller) {
  const auto progress = caller.progress(scenario.name, scenario.frames, "frames");
  std::vector<bench::DetectorRun> detectors;
  for (Watching& one : all) {
    detectors.push_back(
        {*one.detector, [&](const recording::FrameRecord& frame, const cv::Mat3b& image) {
           caller.check();
           one.result->add(frame, image);
           progress->show(frame.index + 1);
         }});
  }
  return frames.run(detectors);
}

/// Writes the files that depend on all frames, and puts all results in their places.
/// \return the figures of each detector.
std::vector<scoring::Metrics> finish(const RunRequest& request, const scenario::Scenario& scenario,
                                     const Frames& frames, const bench::RunEnd& end,
                                     std::vector<Watching>& all, Caller& caller) {
  std::vector<scoring::Metrics> metrics;
  std::vector<files::Output*> outputs;
  for (Watching& one : all) {
    const bool is_own = &one == &all.front();
    metrics.push_back(one.result->finish(end.warnings));
    if (!is_own) one.result->share_truth(*all.front().result);
    write_how_made(request, scenario, frames, one, is_own);
    outputs.push_back(&one.result->output());
  }
  caller.check();
  files::commit_all(outputs);
  return metrics;
}

}  // namespace

comparators::DetectorSpec spec_of(const DetectorChoice& choice) {
  if (!choice.command.empty()) {
    note_files(choice.command);
    return comparators::spec_of_program(choice.name, {choice.command, choice.timeout_s});
  }
  if (!choice.detections.empty()) return comparators::spec_of_file(choice.name, choice.detections);
  return comparators::spec_of(choice.name.empty() ? "lcs" : choice.name);
}

RunMade run(const RunRequest& request, Caller& caller) {
  std::vector<std::string> sets = request.sets;
  if (!request.frames.empty()) sets.push_back("frames=" + request.frames);
  return run_scenario(
      request, scenario::load(request.scenario, {.sets = sets, .seed = request.seed}), caller);
}

RunMade run_scenario(const RunRequest& request, scenario::Scenario scenario, Caller& caller) {
  // Validate the whole request before any output is begun.
  std::optional<replay::Playback> playback;
  if (scenario.recording) scenario = playback.emplace(scenario).scenario();
  std::vector<Watching> all = watching(request, scenario);
  scoring::require_known_metrics(scenario.criteria);
  const Frames frames = frames_of(request, scenario, playback ? &*playback : nullptr);
  make_detectors(request, scenario, frames, all, caller);
  open_results(request, scenario, frames, all, caller);
  warn_before(scenario, all, caller);
  const bench::RunEnd end = watch(scenario, frames, all, caller);
  caller.warn(frames.missing());
  caller.check();
  std::vector<scoring::Metrics> metrics = finish(request, scenario, frames, end, all, caller);

  const Watching& own = all.front();
  caller.warn(recording::lines_of(own.result->warned()));
  if (playback && request.recorded.empty()) {
    for (const std::string& line : playback->remarks()) caller.tell(line);
  }
  for (const std::string& line : end.diagnostics.front().lines()) caller.tell(line);
  for (const std::string& line : own.detector->remarks()) caller.tell(line);
  RunMade made;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto asked = scoring::asked_of(all[i].spec.name, i == 0, scenario.criteria);
    made.detectors.push_back({.name = all[i].spec.name,
                              .criteria = scoring::judge(asked, metrics[i]),
                              .metrics = std::move(metrics[i]),
                              .folder = all[i].result->output().target()});
  }
  if (playback) made.pictures_skipped = playback->skipped();
  made.scenario = std::move(scenario);
  return made;
}

}  // namespace lcs::app
