/// \file
/// `lcs run`: simulates a scenario, runs a detector on its frames, scores it and reports. `lcs
/// replay`: the same on a recording that options describe instead of a scenario file.
#include "scenarios/keys.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "tools/app/replay.h"
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
  scoring::Format format = {};
};

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

/// Prints the figures and the missed criteria of a run.
ExitCode show_run(const app::RunMade& made, bool quiet, scoring::Format format) {
  if (format != scoring::Format::text && !quiet) {
    std::vector<std::pair<std::string, scoring::Metrics>> detectors;
    for (const app::DetectorMade& one : made.detectors) {
      detectors.emplace_back(one.name, one.metrics);
    }
    print_out("{}", table_text(output::figure_table(detectors), format));
  } else if (!quiet) {
    for (const app::DetectorMade& one : made.detectors) {
      print_result(made.scenario, one.name, one.metrics, made.pictures_skipped, one.folder);
    }
  }
  bool failed = false;
  for (const app::DetectorMade& one : made.detectors) failed |= report_missed(one.criteria);
  return failed ? kCriterionFailed : kFine;
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
  const ExitCode code = show_run(app::run(request, terminal), options.quiet, options.format);
  if (view) view->hold();
  return code;
}

app::Options options_of(RunOptions& options) {
  app::Options all = app::options_of(options.request);
  all.add("--keys", "", &options.keys, {.prints = scenario::keys_text});
  all.add("--view", "", &options.view);
  all.add_quiet(options.quiet);
  add_format(all, options.format);
  return all;
}

struct ReplayOptions {
  app::ReplayRequest request;
  std::string write;  ///< scenario file to write instead of running; "": run
  bool force = false;
  bool quiet = false;
};

ExitCode replay(const ReplayOptions& options) {
  if (!options.write.empty()) {
    app::write_scenario(options.request, options.write, files::overwrite(options.force));
    return kFine;
  }
  Terminal terminal(options.quiet);
  return show_run(app::replay(options.request, terminal), options.quiet, scoring::Format::text);
}

app::Options options_of(ReplayOptions& options) {
  app::Options all = app::options_of(options.request);
  all.add("--write", "FILE", &options.write, {.is_output = true});
  all.add_force(options.force);
  all.add_quiet(options.quiet);
  return all;
}

}  // namespace

Command run_command() {
  return command_of(
      "Simulate a scenario, or read its recording, run the LCS filter (or a comparator) on it, and "
      "score it by the truth",
      kRunHelp, &run);
}

Command replay_command() {
  return command_of("Run the LCS filter (or a comparator) on a recording", kReplayHelp, &replay);
}

}  // namespace lcs::tools
