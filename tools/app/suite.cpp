#include "tools/app/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "scenarios/scenes.h"
#include "tools/app/how_made.h"
#include "tools/app/version.h"
#include "tools/bench/detector.h"
#include "tools/comparators/detectors.h"
#include "tools/files/json_node.h"
#include "tools/files/output.h"
#include "tools/files/sha256.h"
#include "tools/input/inputs_read.h"
#include "tools/input/message.h"
#include "tools/output/result.h"
#include "tools/scoring/criteria.h"
#include "tools/suite/plan.h"
#include "tools/suite/suite_run.h"

namespace lcs::app {
namespace {

namespace fs = std::filesystem;

/// The earlier suite at the target, if it is readable. Its times only help to schedule the runs.
std::optional<suite::SuiteResult> former_suite(const fs::path& target) {
  try {
    return suite::read_suite(target / suite::kSuiteFile);
  } catch (const std::exception&) {
    return std::nullopt;
  }
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
std::set<std::string> names_of_all(const SuiteRequest& request, const std::string& own) {
  std::set<std::string> names{own};
  for (const std::string& name : request.beside) {
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

/// Leaves only the runs of the requested part.
/// \param whole all runs: scenarios with their seeds. \param seconds of each run.
suite::PartOf choose_part(const SuiteRequest& request,
                          std::vector<std::pair<std::string, std::vector<std::uint64_t>>> whole,
                          const std::vector<double>& seconds,
                          std::set<std::pair<std::string, std::uint64_t>>& chosen) {
  const suite::Shard shard = suite::shard_of(request.shard);
  if (static_cast<std::size_t>(shard.parts) > seconds.size()) {
    throw std::invalid_argument(fmt::format("--shard {}: there are only {} runs; make fewer parts",
                                            request.shard, seconds.size()));
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

void note_digests(SuitePlan& planned) {
  if (!planned.part_of) return;
  for (const suite::PlannedScenario& one : planned.plan) {
    planned.part_of->scenario_sha256[one.name] = bench::sha256_of_file(one.file).value_or("none");
  }
}

/// Worlds are chosen before they are drawn, so that only those of this part are drawn.
SuitePlan plan_worlds(const SuiteRequest& request, int seeds,
                      const std::optional<suite::SuiteResult>& former, Caller& caller) {
  std::vector<worlds::Kept> chosen = chosen_worlds(request.worlds, request.filter);
  SuitePlan planned;
  std::set<std::pair<std::string, std::uint64_t>> runs;
  if (!request.shard.empty()) {
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
    planned.part_of = choose_part(request, std::move(whole), seconds, runs);
    std::erase_if(chosen, [&](const worlds::Kept& one) {
      const auto first = runs.lower_bound({one.file.stem().string(), 0});
      return first == runs.end() || first->first != one.file.stem();
    });
  }
  draw_worlds(chosen, jobs_at_once(request.jobs), caller);
  std::vector<fs::path> files;
  for (const worlds::Kept& one : chosen) files.push_back(one.file);
  planned.plan = suite::plan(
      {.paths = files, .group = request.group, .filter = {}, .sets = request.sets, .seeds = seeds});
  if (planned.part_of) suite::keep_runs(planned.plan, runs);
  note_digests(planned);
  return planned;
}

SuitePlan plan_scenarios(const SuiteRequest& request, int seeds,
                         const std::optional<suite::SuiteResult>& former) {
  SuitePlan planned;
  planned.plan = suite::plan({.paths = {request.paths.begin(), request.paths.end()},
                              .group = request.group,
                              .filter = request.filter,
                              .sets = request.sets,
                              .seeds = seeds});
  if (request.shard.empty()) return planned;
  std::vector<std::pair<std::string, std::vector<std::uint64_t>>> whole;
  for (const suite::PlannedScenario& one : planned.plan) whole.emplace_back(one.name, one.seeds);
  std::set<std::pair<std::string, std::uint64_t>> runs;
  planned.part_of =
      choose_part(request, std::move(whole), suite::estimated_seconds(planned.plan, former), runs);
  suite::keep_runs(planned.plan, runs);
  note_digests(planned);
  return planned;
}

/// What the runs of a suite depend on. If any of it changes, kept runs do not fit.
nlohmann::ordered_json request_of(const SuiteRequest& request, const SuitePlan& planned,
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
  return {{"detector", app::spec_of(request.detector).name},
          {"arguments", arguments_of(request.detector)},
          {"detections", request.detector.detections},
          {"beside", request.beside},
          {"settings", request.sets},
          {"recorded", request.recorded},
          {"keep", request.keep},
          {"shard", request.shard},
          {"program_sha256", program_sha256()},
          {"versions", version},
          {"runs", count},
          {"scenarios", runs}};
}

/// Goes on with an unfinished suite of the same request, or begins anew.
/// \throws std::runtime_error if there is an unfinished suite of another request.
void begin(bench::Output& folder, const nlohmann::ordered_json& json, const SuiteRequest& request) {
  const fs::path file = folder.staging() / bench::kHowMadeFile;
  if (fs::exists(file) && !request.anew) {
    constexpr input::FileKind kKind{bench::kMostJsonBytes, "give --anew to begin again"};
    const auto kept = bench::parse_json<nlohmann::ordered_json>(input::read_file(file, kKind));
    for (const auto& [key, value] : json.items()) {
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
  write_how_made(folder.staging(), suite::shell_line(arguments_of(request)), {}, json);
}

void remove_runs(const fs::path& folder, suite::SuiteResult& result) {
  for (suite::ScenarioResult& scenario : result.scenarios) {
    for (suite::RunResult& run : scenario.runs) run.folder.clear();
  }
  fs::remove_all(folder / "runs");
}

}  // namespace

SuitePlan plan_suite(const SuiteRequest& request, Caller& caller) {
  std::optional<suite::SuiteResult> times;
  if (!request.times.empty()) times = suite::read_suite(request.times);
  const bool of_worlds = !request.worlds.split.empty();
  const int seeds = request.seeds.value_or(of_worlds ? 1 : 3);
  return of_worlds ? plan_worlds(request, seeds, times, caller)
                   : plan_scenarios(request, seeds, times);
}

SuiteMade suite(const SuiteRequest& request, Caller& caller, SuiteWatch& watch) {
  // Validate the request before anything runs.
  const comparators::DetectorSpec spec = app::spec_of(request.detector);
  const std::string& own = spec.name;
  const std::set<std::string> watching = names_of_all(request, own);
  std::string recorded;
  if (!request.recorded.empty()) {
    comparators::require_corners_suffice(spec);
    recorded = fmt::format("{}, {}", request.recorded, suite::read_suite(request.recorded).version);
  }
  const bool of_worlds = !request.worlds.split.empty();
  const SuitePlan planned = plan_suite(request, caller);
  const std::vector<suite::PlannedScenario>& plan = planned.plan;
  if (!request.detector.detections.empty()) require_detections(request.detector.detections, plan);
  caller.warn(seldom_meant(plan, spec));
  caller.warn(bench::not_asked(criteria_of(plan), watching));
  const std::optional<suite::SuiteResult> baseline = baseline_of(request.place);
  const std::string version = version_line();
  const nlohmann::ordered_json json = request_of(request, planned, version);
  note_longer(request.place.out, request.place.is_named(), "runs",
              json.at("runs").get<std::size_t>(), caller);

  bench::Output folder(request.place.out, suite::suite_files(), bench::Unfinished::kept);
  begin(folder, json, request);
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
      caller.note(fmt::format("going on, with {} of the runs there already", whole));
    }
    std::vector<suite::SuiteResult> results = suite::run_suite(
        plan,
        {.watchers = watchers,
         .own_detector = with_own ? arguments_of(request.detector) : std::vector<std::string>{},
         .detections = with_own ? request.detector.detections : "",
         .keep = request.keep,
         .sets = request.sets,
         .recorded = recordings,
         .version = version,
         .jobs = jobs_at_once(request.jobs),
         .former = former_suite(folder.target() / part_of(detectors.front(), own)),
         .on_run =
             [&](const suite::SuiteProgress& done, const std::string& scenario,
                 std::span<const suite::RunResult* const> runs) {
               folder.keep();
               whole = done.done;
               total = done.total;
               watch.finished(done, scenario, detectors, runs);
             },
         .on_tick =
             [&](const suite::SuiteProgress& now) {
               total = now.total;
               caller.check();
               watch.show(now);
             }});
    caller.check();
    for (suite::SuiteResult& result : results) {
      result.part_of = planned.part_of;
      if (!of_worlds) continue;
      result.split = request.worlds.split;
      add_origins(result);
    }
    return results;
  };
  // Detectors that need pictures cannot use a recording: they simulate in runs of their own.
  std::vector<std::string> beside_own{own}, apart;
  for (const std::string& name : request.beside) {
    const bool looks = comparators::spec_of(name).detector.sees_pictures;
    (looks && !request.recorded.empty() ? apart : beside_own).push_back(name);
  }
  try {
    std::vector<suite::SuiteResult> others = run(beside_own, request.recorded);
    suite::SuiteResult result = std::move(others.front());
    others.erase(others.begin());
    if (!apart.empty()) std::ranges::move(run(apart, ""), std::back_inserter(others));
    watch.wipe();
    if (request.keep == bench::Keep::figures) {  // suite.json has them
      remove_runs(folder.staging() / part_of(own, own), result);
      for (suite::SuiteResult& other : others) {
        remove_runs(folder.staging() / part_of(other.detector, own), other);
      }
    }
    result.recorded = recorded;
    for (const suite::SuiteResult& other : others) result.beside.push_back(other.detector);
    if (of_worlds) write_sheets(folder.staging(), plan, result, caller);
    return finish_suite(folder, request.place, std::move(result), std::move(others), baseline,
                        caller);
  } catch (const Interrupted&) {
    watch.wipe();
    if (whole == 0) throw;
    throw Interrupted(
        fmt::format("interrupted; {} of {} runs are kept, and the same command goes on from there",
                    whole, total));
  }
}

}  // namespace lcs::app
