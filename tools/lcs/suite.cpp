#include "tools/lcs/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include "scenarios/scenes.h"
#include "tools/bench/detector.h"
#include "tools/comparators/detectors.h"
#include "tools/files/json_node.h"
#include "tools/files/output.h"
#include "tools/files/sha256.h"
#include "tools/input/inputs_read.h"
#include "tools/input/message.h"
#include "tools/lcs/detector_option.h"
#include "tools/lcs/how_made.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/suite_progress.h"
#include "tools/lcs/terminal.h"
#include "tools/lcs/version.h"
#include "tools/output/result.h"
#include "tools/scoring/criteria.h"
#include "tools/suite/pattern.h"
#include "tools/suite/plan.h"
#include "tools/suite/suite_run.h"

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
  lcs suite --worlds train --count 1000 --keep figures    a thousandth of the disk
  lcs suite --worlds train --count 1000 --shard 2/16 --out part2
                                                  a part, on one of 16 machines; lcs merge joins them
  lcs compare out/before out/suite                what two suites differ in, beyond noise

Worlds are kept in out/worlds/ and drawn anew only where the generator changed. A kept world that was edited is
refused. Those of the split `test` are for stating figures: nothing is chosen by them (tools/worlds/README.md).

Seeds are the scenario's own and those that follow. Each run is a process of its own; one that
crashes, or a scenario that is broken, is an error, and the others still run.

A suite that was interrupted or killed goes on by the same command: finished runs are kept in DIR.unfinished/.

Files written to the folder, all or none:
  run.json      how it was made: command, program, settings, versions, date
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
  130  interrupted (Ctrl-C): finished runs are kept, an earlier suite is as it was
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

/// The planned runs, and of which whole they are a part.
struct Planned {
  std::vector<suite::PlannedScenario> plan;
  std::optional<suite::PartOf> part_of;
};

/// Leaves only the runs of the requested part.
/// \param whole all runs: scenarios with their seeds. \param seconds of each run.
suite::PartOf choose_part(const SuiteOptions& options,
                          std::vector<std::pair<std::string, std::vector<std::uint64_t>>> whole,
                          const std::vector<double>& seconds,
                          std::set<std::pair<std::string, std::uint64_t>>& chosen) {
  const suite::Shard shard = suite::shard_of(options.shard);
  if (static_cast<std::size_t>(shard.parts) > seconds.size()) {
    throw std::invalid_argument(fmt::format("--shard {}: there are only {} runs; make fewer parts",
                                            options.shard, seconds.size()));
  }
  const std::vector<int> parts = suite::parts_of(seconds, shard.parts);
  std::size_t next = 0;
  for (const auto& [name, seeds] : whole) {
    for (const std::uint64_t seed : seeds) {
      if (parts[next++] == shard.part) chosen.emplace(name, seed);
    }
  }
  return {.shard = shard, .whole = std::move(whole)};
}

void note_digests(Planned& planned) {
  if (!planned.part_of) return;
  for (const suite::PlannedScenario& one : planned.plan) {
    planned.part_of->scenario_sha256[one.name] = bench::sha256_of_file(one.file).value_or("none");
  }
}

/// Worlds are chosen before they are drawn, so that only those of this part are drawn.
Planned plan_worlds(const SuiteOptions& options, int seeds,
                    const std::optional<suite::SuiteResult>& former) {
  std::vector<worlds::Kept> chosen = chosen_worlds(options.worlds);
  const suite::Pattern filter(options.filter, "--filter", "^room");
  std::erase_if(chosen, [&](const auto& one) { return !filter.is_in(one.file.stem().string()); });
  if (chosen.empty()) throw std::runtime_error("no world fits --filter; its names are as room_7");
  Planned planned;
  std::set<std::pair<std::string, std::uint64_t>> runs;
  if (!options.shard.empty()) {
    std::vector<std::pair<std::string, std::vector<std::uint64_t>>> whole;
    std::vector<double> seconds;
    for (const worlds::Kept& one : chosen) {
      auto& [name, own] = whole.emplace_back(one.file.stem().string(), 0);
      for (int k = 0; k < seeds; ++k) {
        own.push_back(one.choice.seed + static_cast<std::uint64_t>(k));
        const auto known = former ? suite::former_seconds(*former, name, own.back()) : std::nullopt;
        seconds.push_back(known.value_or(1));
      }
    }
    planned.part_of = choose_part(options, std::move(whole), seconds, runs);
    std::erase_if(chosen, [&](const worlds::Kept& one) {
      const auto first = runs.lower_bound({one.file.stem().string(), 0});
      return first == runs.end() || first->first != one.file.stem();
    });
  }
  draw_worlds(chosen, jobs_at_once(options));
  std::vector<fs::path> files;
  for (const worlds::Kept& one : chosen) files.push_back(one.file);
  planned.plan = suite::plan(
      {.paths = files, .group = options.group, .filter = {}, .sets = options.sets, .seeds = seeds});
  if (planned.part_of) suite::keep_runs(planned.plan, runs);
  note_digests(planned);
  return planned;
}

Planned plan_scenarios(const SuiteOptions& options, int seeds,
                       const std::optional<suite::SuiteResult>& former) {
  Planned planned;
  planned.plan = suite::plan({.paths = {options.paths.begin(), options.paths.end()},
                              .group = options.group,
                              .filter = options.filter,
                              .sets = options.sets,
                              .seeds = seeds});
  if (options.shard.empty()) return planned;
  std::vector<std::pair<std::string, std::vector<std::uint64_t>>> whole;
  for (const suite::PlannedScenario& one : planned.plan) whole.emplace_back(one.name, one.seeds);
  std::set<std::pair<std::string, std::uint64_t>> runs;
  planned.part_of =
      choose_part(options, std::move(whole), suite::estimated_seconds(planned.plan, former), runs);
  suite::keep_runs(planned.plan, runs);
  note_digests(planned);
  return planned;
}

/// What the runs of a suite depend on. If any of it changes, kept runs do not fit.
nlohmann::ordered_json request_of(const SuiteOptions& options, const Planned& planned,
                                  const std::string& version) {
  nlohmann::ordered_json runs = nlohmann::ordered_json::array();
  std::size_t count = 0;
  for (const suite::PlannedScenario& one : planned.plan) {
    const auto digest = [](const fs::path& file) {
      return bench::sha256_of_file(file).value_or("none");
    };
    runs.push_back({{"name", one.name},
                    {"seeds", one.seeds},
                    {"scenario_sha256", digest(one.file)},
                    {"scene_sha256", one.scenario ? digest(one.scenario->scene) : ""}});
    count += one.seeds.size();
  }
  return {{"detector", tools::spec_of(options.detector).name},
          {"arguments", arguments_of(options.detector)},
          {"detections", options.detector.detections},
          {"beside", options.beside},
          {"settings", options.sets},
          {"recorded", options.recorded},
          {"keep", options.keep},
          {"shard", options.shard},
          {"program_sha256", program_sha256()},
          {"versions", version},
          {"runs", count},
          {"scenarios", runs}};
}

/// Goes on with an unfinished suite of the same request, or begins anew.
/// \throws std::runtime_error if there is an unfinished suite of another request.
void begin(bench::Output& folder, const nlohmann::ordered_json& request, bool anew) {
  const fs::path file = folder.staging() / bench::kHowMadeFile;
  if (fs::exists(file) && !anew) {
    constexpr input::FileKind kKind{bench::kMostJsonBytes, "give --anew to begin again"};
    const auto kept = bench::parse_json<nlohmann::ordered_json>(input::read_file(file, kKind));
    for (const auto& [key, value] : request.items()) {
      if (kept.contains(key) && kept.at(key) == value) continue;
      throw std::runtime_error(fmt::format(
          "{} holds the runs of an unfinished suite, and its {} differ: finish it by its own "
          "command, {}; or give --anew to drop its runs",
          folder.staging().parent_path().string(), key,
          kept.contains("command") && kept.at("command").is_string()
              ? kept.at("command").get<std::string>()
              : ""));
    }
    return;
  }
  if (!fs::is_empty(folder.staging())) folder.empty();
  write_how_made(folder.staging(), suite::shell_line(command_line()), {}, request);
}

void remove_runs(const fs::path& folder, suite::SuiteResult& result) {
  for (suite::ScenarioResult& scenario : result.scenarios) {
    for (suite::RunResult& run : scenario.runs) run.folder.clear();
  }
  fs::remove_all(folder / "runs");
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
  add_keep_option(command, options.keep);
  command
      .add_option(
          "--shard", options.shard,
          "Only a part of the runs, as 2/5, on one of several machines; lcs merge joins the "
          "parts")
      ->type_name("I/N");
  command
      .add_option("--times", options.times,
                  "With --shard: an earlier suite, whose times balance the parts; the same for "
                  "all parts")
      ->type_name("FILE")
      ->needs("--shard");
  add_suite_end_options(command, options.end);
  command.add_flag("--anew", options.anew,
                   "Drop the runs of an unfinished suite in the same place, and begin again");
  command.add_flag("--list", options.list, "Only list what would be run");
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
  std::optional<suite::SuiteResult> times;
  if (!options.times.empty()) times = suite::read_suite(options.times);
  const int seeds = options.seeds.value_or(of_worlds ? 1 : 3);
  const Planned planned =
      of_worlds ? plan_worlds(options, seeds, times) : plan_scenarios(options, seeds, times);
  const std::vector<suite::PlannedScenario>& plan = planned.plan;
  if (options.list) return list_plan(plan);
  if (!options.detector.detections.empty()) require_detections(options.detector.detections, plan);
  warn(seldom_meant(plan, spec));
  warn(bench::not_asked(criteria_of(plan), watching));
  const std::optional<suite::SuiteResult> baseline = baseline_of(options.end);
  const std::string version = version_line();
  const nlohmann::ordered_json request = request_of(options, planned, version);
  note_longer(options.end.out, options.end.is_named(), "runs",
              request.at("runs").get<std::size_t>());

  bench::Output folder(options.end.out, suite::suite_files(), bench::Unfinished::kept);
  begin(folder, request, options.anew);
  SuiteProgress progress(options.end.quiet);
  std::size_t whole = 0, total = 0;
  const auto run = [&](const std::vector<std::string>& detectors, const fs::path& recordings) {
    const bool with_own = detectors.front() == own;
    std::vector<suite::SuiteWatcher> watchers;
    for (const std::string& name : detectors) {
      const bool is_own = name == own;
      watchers.push_back({name, folder.staging() / part_of(name, own), is_own});
      fs::create_directories(watchers.back().folder);
    }
    whole = suite::count_whole(plan, watchers);
    if (whole > 0) {
      if (!options.end.quiet)
        tell(fmt::format("going on, with {} of the runs there already", whole));
    }
    std::vector<suite::SuiteResult> results = suite::run_suite(
        plan,
        {.watchers = watchers,
         .own_detector = with_own ? arguments_of(options.detector) : std::vector<std::string>{},
         .detections = with_own ? options.detector.detections : "",
         .keep = options.keep,
         .sets = options.sets,
         .recorded = recordings,
         .version = version,
         .jobs = jobs_at_once(options),
         .former = former_suite(folder.target() / part_of(detectors.front(), own)),
         .on_run =
             [&](const suite::SuiteProgress& done, const std::string& scenario,
                 std::span<const suite::RunResult* const> runs) {
               folder.keep();
               whole = done.done;
               total = done.total;
               progress.finished(done, scenario, detectors, runs);
             },
         .on_tick =
             [&](const suite::SuiteProgress& now) {
               total = now.total;
               check_interrupted();
               progress.show(now);
             }});
    check_interrupted();
    for (suite::SuiteResult& result : results) {
      result.part_of = planned.part_of;
      if (!of_worlds) continue;
      result.split = options.worlds.split;
      add_origins(result);
    }
    return results;
  };
  // Detectors that need pictures cannot use a recording: they simulate in runs of their own.
  std::vector<std::string> beside_own{own}, apart;
  for (const std::string& name : options.beside) {
    const bool looks = comparators::spec_of(name).detector.sees_pictures;
    (looks && !options.recorded.empty() ? apart : beside_own).push_back(name);
  }
  try {
    std::vector<suite::SuiteResult> others = run(beside_own, options.recorded);
    suite::SuiteResult result = std::move(others.front());
    others.erase(others.begin());
    if (!apart.empty()) std::ranges::move(run(apart, ""), std::back_inserter(others));
    progress.wipe();
    if (options.keep == bench::Keep::figures) {  // suite.json has them
      remove_runs(folder.staging() / part_of(own, own), result);
      for (suite::SuiteResult& other : others) {
        remove_runs(folder.staging() / part_of(other.detector, own), other);
      }
    }
    result.recorded = recorded;
    for (const suite::SuiteResult& other : others) result.beside.push_back(other.detector);
    if (of_worlds) write_sheets(folder.staging(), plan, result);
    return finish_suite(folder, options.end, result, others, baseline);
  } catch (const Interrupted&) {
    progress.wipe();
    if (whole == 0) throw;
    throw Interrupted(
        fmt::format("interrupted; {} of {} runs are kept, and the same command goes on from there",
                    whole, total));
  }
}

}  // namespace lcs::tools
