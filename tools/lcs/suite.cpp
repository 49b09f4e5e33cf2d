#include "tools/lcs/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include "scenarios/scenes.h"
#include "tools/bench/detector.h"
#include "tools/comparators/detectors.h"
#include "tools/files/output.h"
#include "tools/files/output_file.h"
#include "tools/input/inputs_read.h"
#include "tools/input/message.h"
#include "tools/lcs/detector_option.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/suite_progress.h"
#include "tools/lcs/terminal.h"
#include "tools/lcs/version.h"
#include "tools/report/report_page.h"
#include "tools/scoring/criteria.h"
#include "tools/suite/beside_table.h"
#include "tools/suite/comparison.h"
#include "tools/suite/junit.h"
#include "tools/suite/plan.h"
#include "tools/suite/suite_run.h"
#include "tools/suite/suite_table.h"
#include "tools/suite/summary.h"
#include "tools/suite/verdict.h"

namespace lcs::tools {
namespace {

constexpr int kMostJobs = 1024;
constexpr int kMostSeeds = 1000;

constexpr const char* kHelp = R"(Examples:
  lcs suite                                       every short scenario of the project, 3 seeds each
  lcs suite --seeds 1 --worst-first               quicker, and where to look first
  lcs suite --filter crossing --set filter.hypotheses.prior=0.05 --out out/r60
  lcs suite --recorded out/suite --out out/mine --baseline out/suite
                                                  the filter anew on the frames of an earlier suite
  lcs suite --beside klt --beside lcs:lab         F1 beside what it is measured against, and by the
                                                  filter with the paper's preset
  lcs suite --detector mine --detector-command 'python3 mine.py' --beside lcs --beside klt
                                                  a detector of yours beside the filter
  lcs suite --recorded out/suite --detections csv --out out/mine
                                                  what it has written of an earlier suite's frames
  lcs suite --group sweep --filter distance       a sweep: one run a point and seed
  lcs suite my_scenarios other.yaml               other scenarios, of any group
  lcs suite --group all --list                    what there is
  lcs suite --worlds train --count 60             worlds drawn from seeds, one run each
  lcs suite --worlds test --count 60 --beside klt --beside dis --beside lcs:lab
                                                  how far the filter is from its yardsticks, by family
  lcs compare out/before out/suite                what two suites differ in, beyond noise

Worlds are kept in out/worlds/ and drawn anew only where the generator changed. A kept world that was edited is
refused. Those of the split `test` are for stating figures: nothing is chosen by them (tools/worlds/README.md).

Seeds are the scenario's own and those that follow. Each run is a process of its own; one that
crashes, or a scenario that is broken, is an error, and the others still run.

Files written to the folder, all or none:
  suite.json    every figure and criterion of every run
  report.html   all of it to look at: figures against the baseline, plots, and for each miss and
                false alarm the reasons and a strip of pictures; open it in a browser
  worlds.html, worlds/   of worlds: three pictures and the plan of each, with its figures
  junit.xml     a test case a criterion, for continuous integration
  runs/NAME/seed-N/   what `lcs run --events` leaves, without a video
  beside/DETECTOR/    with --beside: suite.json and runs/ of that detector, without events and
                      pictures, for lcs compare
  standing.md   with --beside: a row a detector, with its means, in Markdown

Exit codes:
  0  fine
  1  a required criterion is not met; with --fail-on-regression also: a mean regressed, or a run
     that had figures before ended with an error
  2  a run ended with an error, or nothing could be run
  130  interrupted (Ctrl-C): nothing was written, an earlier suite is as it was
)";

namespace fs = std::filesystem;

std::size_t jobs_at_once(const SuiteOptions& options) {
  if (options.jobs > 0) return static_cast<std::size_t>(options.jobs);
  return std::max(1U, std::thread::hardware_concurrency());
}

/// The earlier suite at the target, if it is readable. Its times only help to schedule the runs.
std::optional<suite::SuiteResult> former_suite(const fs::path& target) {
  try {
    return suite::read_suite(target / suite::kSuiteFile);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

ExitCode list_plan(const std::vector<suite::PlannedScenario>& plan) {
  std::size_t longest = 0;
  for (const suite::PlannedScenario& planned : plan)
    longest = std::max(longest, planned.name.size());
  bool is_broken = false;
  for (const suite::PlannedScenario& planned : plan) {
    if (planned.scenario) {
      const int frames = planned.scenario->frames;  // 0: all frames of a recording
      print_out("{:<{}}  {:>4} frames, {} criteria [{}] {}\n", planned.name, longest,
                frames > 0 ? std::to_string(frames) : "all", planned.scenario->criteria.size(),
                fmt::join(planned.scenario->groups, ", "), planned.scenario->purpose);
    } else {
      tell("error: " + planned.error);
      is_broken = true;
    }
  }
  return is_broken ? kError : kFine;
}

/// Warnings about likely mistakes in all scenarios, without duplicates. The runs report invalid
/// settings.
std::vector<std::string> seldom_meant(const std::vector<suite::PlannedScenario>& plan,
                                      const comparators::DetectorSpec& spec) {
  std::vector<std::string> lines;
  const auto add = [&](const std::vector<std::string>& more) {
    for (const std::string& line : more) {
      if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
    }
  };
  for (const suite::PlannedScenario& planned : plan) {
    if (!planned.scenario) continue;
    add(scenario::shadowed_files(*planned.scenario));
    try {
      scenario::Scenario scenario = *planned.scenario;
      add(comparators::apply_preset(spec, scenario));
    } catch (const input::Error&) {
    }
  }
  return lines;
}

/// Prints the changes, worst first. The verdict comes last, where the terminal ends.
void print_changes(const suite::Verdict& verdict, const suite::Comparison& comparison,
                   const std::string& baseline) {
  print_out("Against {}:\n", baseline);
  for (const std::string& what : comparison.incomparable) {
    print_out("not compared: {}\n", input::printable(what));
  }
  print_out("{}", input::printable(suite::means_text(comparison, false)));
  print_out("{}", input::printable(suite::text_of(verdict)));
}

/// The suite's own detector and those of `--beside`. \throws std::invalid_argument for duplicates.
std::set<std::string> names_of_all(const SuiteOptions& options, const std::string& own) {
  std::set<std::string> names{own};
  for (const std::string& name : options.beside) {
    comparators::spec_of(name);
    if (!names.insert(name).second) {
      throw std::invalid_argument(fmt::format("--beside {}: it is run already", name));
    }
  }
  return names;
}

std::vector<scenario::Criterion> criteria_of(const std::vector<suite::PlannedScenario>& plan) {
  std::vector<scenario::Criterion> all;
  for (const suite::PlannedScenario& planned : plan) {
    if (planned.scenario) std::ranges::copy(planned.scenario->criteria, std::back_inserter(all));
  }
  return all;
}

/// The folder of a detector's results, relative to the suite's folder.
fs::path part_of(const std::string& detector, const std::string& own) {
  return detector == own ? fs::path() : fs::path("beside") / detector;
}

/// \throws std::runtime_error that lists all missing files of detections.
void require_detections(const fs::path& folder, const std::vector<suite::PlannedScenario>& plan) {
  if (!fs::is_directory(folder)) {
    throw std::invalid_argument(
        fmt::format("--detections {} is no folder; name one that holds {} for each run",
                    folder.string(), suite::detections_of("SCENARIO", 1).string()));
  }
  input::note_input(folder);
  std::vector<std::string> missing;
  for (const suite::PlannedScenario& planned : plan) {
    if (!planned.scenario) continue;
    for (const std::uint64_t seed : planned.seeds) {
      const fs::path file = suite::detections_of(planned.name, seed);
      if (!fs::is_regular_file(folder / file)) missing.push_back(file.string());
    }
  }
  if (missing.empty()) return;
  throw std::runtime_error(fmt::format(
      "{} lacks {} of the files of detections: {}; write them, an empty one where nothing was "
      "found, or choose other runs by --filter and --seeds",
      folder.string(), missing.size(), fmt::join(missing, ", ")));
}

ExitCode exit_code(suite::Outcome outcome) {
  switch (outcome) {
    case suite::Outcome::passed:
      return kFine;
    case suite::Outcome::failed:
      return kCriterionFailed;
    case suite::Outcome::error:
      return kError;
  }
  return kError;
}

}  // namespace

CLI::App& add_suite_command(CLI::App& app, SuiteOptions& options) {
  CLI::App& command = *app.add_subcommand(
      "suite", "Run many scenarios with several seeds each, in parallel, and sum them up");
  command
      .add_option("PATH", options.paths,
                  "Scenario files, and folders of them; the project's own if not given")
      ->type_name("");
  command
      .add_option(
          "--group", options.group,
          "Only scenarios of this group; 'all' for any. If not given: any of paths that are "
          "named, short of the project's own")
      ->type_name("NAME");
  command
      .add_option("--filter", options.filter,
                  "Only scenarios with this regular expression in their name")
      ->type_name("REGEX");
  add_integer_option(command, "--jobs", options.jobs,
                     "Runs at a time; if not given, as many as there are processors", 1, kMostJobs)
      ->type_name("N");
  add_worlds_options(command, options.worlds)->excludes("PATH");
  add_integer_option(command, "--seeds", options.seeds,
                     "Runs of each scenario; 3 if not given, of worlds 1", 1, kMostSeeds)
      ->type_name("N");
  add_detector_option(command, options.detector, kPresetDetector);
  CLI::Option* recorded =
      command
          .add_option("--recorded", options.recorded,
                      "Take corners, motion and truth from an earlier suite instead of simulating, "
                      "which takes seconds")
          ->type_name("DIR");
  command
      .add_option("--detections", options.detector.detections,
                  "With --recorded: what a detector of yours has said, a folder of CSV files "
                  "(tools/recording/DETECTIONS.md), SCENARIO/seed-N.csv for each run")
      ->type_name("DIR")
      ->needs(recorded)
      ->excludes(command.get_option("--detector-command"));
  command
      .add_option(
          "--beside", options.beside,
          "Run this detector too on the same frames, as klt or lcs:lab, and print F1 beside "
          "each other; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_set_option(command, options.sets, "Set a value in every scenario, as \"camera.rate=5 Hz\"");
  add_out_option(command, options.out, "out/suite");
  CLI::Option* baseline =
      command
          .add_option("--baseline", options.baseline,
                      "An earlier suite.json or its folder, to show changes against")
          ->type_name("FILE");
  command
      .add_flag("--fail-on-regression", options.fail_on_regression,
                "Exit with 1 where something regressed against the baseline, as lcs compare does")
      ->needs(baseline);
  command.add_flag("--worst-first", options.worst_first, "Sort the table by F1");
  command.add_flag("--list", options.list, "Only list what would be run");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return command;
}

ExitCode suite(const SuiteOptions& options) {
  // Validate the request before anything runs.
  const comparators::DetectorSpec spec = tools::spec_of(options.detector);
  const std::string& own = spec.name;
  const std::set<std::string> watching = names_of_all(options, own);
  std::string recorded;
  if (!options.recorded.empty()) {
    comparators::require_corners_suffice(spec);
    recorded = fmt::format("{}, {}", options.recorded, suite::read_suite(options.recorded).version);
  }
  const bool of_worlds = !options.worlds.split.empty();
  const std::vector<std::string> paths =
      of_worlds ? make_worlds(options.worlds, jobs_at_once(options)) : options.paths;
  const std::vector<suite::PlannedScenario> plan =
      suite::plan({.paths = {paths.begin(), paths.end()},
                   .group = options.group,
                   .filter = options.filter,
                   .sets = options.sets,
                   .seeds = options.seeds.value_or(of_worlds ? 1 : 3)});
  if (options.list) return list_plan(plan);
  if (!options.detector.detections.empty()) require_detections(options.detector.detections, plan);
  warn(seldom_meant(plan, spec));
  warn(bench::not_asked(criteria_of(plan), watching));
  std::optional<suite::SuiteResult> baseline;
  if (!options.baseline.empty()) baseline = suite::read_suite(options.baseline);

  bench::Output folder(options.out, suite::suite_files());
  SuiteProgress progress(options.quiet);
  const auto run = [&](const std::vector<std::string>& detectors, const fs::path& recordings) {
    const bool with_own = detectors.front() == own;
    std::vector<suite::SuiteWatcher> watchers;
    for (const std::string& name : detectors) {
      const bool is_own = name == own;
      watchers.push_back({name, folder.staging() / part_of(name, own), is_own});
      fs::create_directories(watchers.back().folder);
    }
    std::vector<suite::SuiteResult> results = suite::run_suite(
        plan,
        {.watchers = watchers,
         .own_detector = with_own ? arguments_of(options.detector) : std::vector<std::string>{},
         .detections = with_own ? options.detector.detections : "",
         .sets = options.sets,
         .recorded = recordings,
         .version = version_line(),
         .jobs = jobs_at_once(options),
         .former = former_suite(folder.target() / part_of(detectors.front(), own)),
         .on_run =
             [&](const suite::SuiteProgress& done, const std::string& scenario,
                 std::span<const suite::RunResult* const> runs) {
               progress.finished(done, scenario, detectors, runs);
             },
         .on_tick =
             [&](const suite::SuiteProgress& now) {
               check_interrupted();
               progress.show(now);
             }});
    check_interrupted();
    if (of_worlds) {
      for (suite::SuiteResult& result : results) add_origins(result);
    }
    return results;
  };
  // Detectors that need pictures cannot use a recording: they simulate in runs of their own.
  std::vector<std::string> beside_own{own}, apart;
  for (const std::string& name : options.beside) {
    const bool looks = comparators::spec_of(name).detector.sees_pictures;
    (looks && !options.recorded.empty() ? apart : beside_own).push_back(name);
  }
  std::vector<suite::SuiteResult> others = run(beside_own, options.recorded);
  suite::SuiteResult result = std::move(others.front());
  others.erase(others.begin());
  if (!apart.empty()) std::ranges::move(run(apart, ""), std::back_inserter(others));
  for (const suite::SuiteResult& other : others) {
    suite::write_suite(folder.staging() / part_of(other.detector, own) / suite::kSuiteFile, other);
  }
  progress.wipe();
  result.recorded = recorded;
  suite::write_suite(folder.staging() / suite::kSuiteFile, result);
  suite::write_junit(folder.staging() / suite::kJunitFile, result, others);
  if (!others.empty()) {
    bench::write_file(folder.staging() / suite::kStandingFile,
                      suite::standing_table(result, others));
  }
  const suite::SuiteInFolder made{result, folder.staging()};
  std::optional<suite::SuiteInFolder> before;
  std::optional<suite::Comparison> comparison;
  if (baseline) {
    before.emplace(suite::SuiteInFolder{*baseline, suite::folder_of(options.baseline)});
    comparison = suite::compare(*baseline, result, [](std::string_view) { return true; });
  }
  const suite::SuiteInFolder* beside = before ? &*before : nullptr;
  const suite::Verdict verdict =
      suite::verdict_of(made, beside, comparison ? &*comparison : nullptr);
  std::optional<report::Against> against;
  if (before) against.emplace(report::Against{*before, *comparison});
  report::write_report(folder.staging() / report::kReportFile, made, verdict,
                       against ? &*against : nullptr);
  if (of_worlds) write_worlds(folder.staging(), options.worlds, plan, result, others);
  folder.commit();

  if (!options.quiet) {
    print_out("{}\n", suite::suite_table(result, options.worst_first));
    if (!others.empty()) print_out("{}\n", suite::beside_table(result, others));
    if (of_worlds) print_out("{}", told_of_worlds(options.worlds, result));
    if (comparison) print_changes(verdict, *comparison, options.baseline);
    print_out("{}; results in {}\n", suite::totals(result), folder.target().string());
  }
  warn(suite::warnings(result));
  suite::Outcome outcome = suite::outcome_of(result);
  for (const std::string& problem : suite::problems(result)) tell(problem);
  for (const suite::SuiteResult& other : others) {
    outcome = std::max(outcome, suite::outcome_of(other));
    for (const std::string& problem : suite::problems(other)) {
      tell(fmt::format("{}: {}", other.detector, problem));
    }
  }
  const bool is_worse = comparison && comparison->has_regressed();
  if (!is_worse || !options.fail_on_regression) return exit_code(outcome);
  tell(fmt::format("against {}: {}", options.baseline, verdict.line));
  return outcome == suite::Outcome::error ? kError : kRegressed;
}

}  // namespace lcs::tools
