#include "tools/app/suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include "scenarios/input/inputs_read.h"
#include "scenarios/scenes.h"
#include "tools/app/how_made.h"
#include "tools/bench/detector.h"
#include "tools/files/json_node.h"
#include "tools/scoring/criteria.h"
#include "tools/suite/parts.h"
#include "tools/suite/sequential.h"
#include "tools/suite/suite_run.h"

namespace lcs::app {
namespace {

bool of_worlds(const SuiteRequest& request) {
  return !request.worlds.split.empty();
}

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

/// The suite's own detector and the `--beside` ones. \throws std::invalid_argument for duplicates.
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

/// Records the files of detections of all runs, including the runs of other parts. So parts that
/// were made from other detections are recognised.
/// \throws std::runtime_error that lists the missing files of the planned runs.
void require_detections(const fs::path& folder, const SuitePlan& planned) {
  if (!fs::is_directory(folder)) {
    throw std::invalid_argument(
        fmt::format("--detections {} is no folder; name one that holds {} for each run",
                    folder.string(), suite::detections_of("SCENARIO", 1).string()));
  }
  input::note_input(folder);
  std::vector<std::string> missing;
  for (const suite::PlannedScenario& one : planned.plan) {
    if (!one.scenario) continue;
    for (const std::uint64_t seed : one.seeds) {
      const fs::path file = suite::detections_of(one.name, seed);
      fs::is_regular_file(folder / file) ? input::note_input(folder / file)
                                         : missing.push_back(file.string());
    }
  }
  if (planned.part_of) {
    for (const auto& [name, seeds] : planned.part_of->whole) {
      for (const std::uint64_t seed : seeds) {
        input::note_input(folder / suite::detections_of(name, seed));
      }
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
suite::PartOf choose_part(const SuiteRequest& request, suite::SuiteRuns whole,
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

/// Worlds are chosen before they are drawn, so that only the worlds of this part are drawn.
SuitePlan plan_worlds(const SuiteRequest& request, int seeds,
                      const std::optional<suite::SuiteResult>& former, Caller& caller) {
  std::vector<worlds::Kept> chosen = chosen_worlds(request.worlds, request.filter);
  SuitePlan planned;
  std::set<std::pair<std::string, std::uint64_t>> runs;
  if (!request.shard.empty()) {
    suite::SuiteRuns whole;
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
  planned.plan = suite::plan({.paths = draw_worlds(chosen, jobs_at_once(request.jobs), caller),
                              .group = request.group,
                              .sets = request.sets,
                              .seeds = seeds});
  if (planned.part_of) suite::keep_runs(planned.plan, runs);
  return planned;
}

suite::SuiteRuns runs_of(const std::vector<suite::PlannedScenario>& plan) {
  suite::SuiteRuns runs;
  for (const suite::PlannedScenario& one : plan) runs.emplace_back(one.name, one.seeds);
  return runs;
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
  for (const suite::PlannedScenario& one : planned.plan) {
    if (one.error.empty()) continue;
    throw std::runtime_error(
        fmt::format("{} (the parts of a suite have to agree on all its scenarios)", one.error));
  }
  std::set<std::pair<std::string, std::uint64_t>> runs;
  planned.part_of = choose_part(request, runs_of(planned.plan),
                                suite::estimated_seconds(planned.plan, former), runs);
  suite::keep_runs(planned.plan, runs);
  return planned;
}

/// The runs are no part of the result: suite.json has their figures.
void forget_folders(suite::SuiteResult& result) {
  for (suite::ScenarioResult& scenario : result.scenarios) {
    for (suite::RunResult& run : scenario.runs) run.folder.clear();
  }
}

/// The settings on which the runs of a suite depend, and the runs.
files::Json facts_of(const SuiteRequest& request, const SuitePlan& planned) {
  files::Json facts{{"detector", app::spec_of(request.detector).name},
                    {"detector_command", request.detector.command},
                    {"detector_timeout_s", request.detector.timeout_s},
                    {"detections", request.detector.detections},
                    {"beside", request.beside},
                    {"settings", request.sets},
                    {"recorded", request.recorded},
                    {"keep", word_of(request.keep)}};
  facts["split"] = request.worlds.split;
  add_program(facts, sim::versions());
  add_changed_program(facts);
  add_part(facts, request.shard, runs_of(planned.plan));
  return facts;
}

/// Writes run.json at once, so that a kill leaves no part of it.
void write_how_made(const files::Output& folder, const SuiteRequest& request,
                    const files::Provenance& provenance) {
  app::write_how_made(folder.work(), suite::shell_line(arguments_of(request)), provenance);
  fs::rename(folder.work() / files::kHowMadeFile, folder.staging() / files::kHowMadeFile);
}

/// Goes on with an unfinished suite of the same provenance, or begins anew.
/// \throws std::runtime_error if there is an unfinished suite of another one.
void begin(files::Output& folder, const files::Provenance& provenance,
           const SuiteRequest& request) {
  const fs::path& staging = folder.staging();
  if (request.anew || !fs::exists(staging / files::kHowMadeFile)) {
    if (!fs::is_empty(staging)) folder.empty();
    return write_how_made(folder, request, provenance);
  }
  const files::Provenance there = files::read_how_made(staging);
  std::string what = files::difference(there, provenance);
  if (what.empty()) what = files::changed_since(there);
  if (what.empty()) return;
  throw std::runtime_error(
      fmt::format("{} holds the runs of an unfinished suite, and {}; finish it by its own command, "
                  "which its run.json has, or give --anew to drop its runs",
                  staging.parent_path().string(), what));
}

/// A run with one of the detectors, without its outputs.
RunRequest run_of(const SuiteRequest& request, const suite::PlannedScenario& planned,
                  std::uint64_t seed, const suite::SuiteDetector& detector,
                  const fs::path& recordings) {
  RunRequest run{.scenario = planned.file.string(), .seed = seed, .sets = planned.sets};
  if (detector.is_own) run.detector = request.detector;
  run.detector.name = detector.detector == "lcs" ? "" : detector.detector;
  if (!run.detector.detections.empty()) {
    const fs::path file = suite::detections_of(planned.name, seed);
    run.detector.detections = (fs::path(run.detector.detections) / file).string();
  }
  if (!recordings.empty()) {
    run.recorded = (recordings / suite::folder_of(planned, seed)).string();
  }
  return run;
}

/// The arguments of a child: the run with the first detector, beside which the others are run.
Texts child_of(const SuiteRequest& request, const suite::PlannedScenario& planned,
               std::uint64_t seed, std::span<const suite::SuiteDetector> detectors,
               const fs::path& recordings) {
  const fs::path folder = suite::folder_of(planned, seed);
  RunRequest run = run_of(request, planned, seed, detectors.front(), recordings);
  run.out = (detectors.front().folder / folder).string();
  run.keep = request.keep;
  run.gzip = true;
  run.video = false;
  run.events = request.keep != output::Keep::figures;
  for (const suite::SuiteDetector& other : detectors.subspan(1)) {
    run.beside.push_back(other.detector + '=' + (other.folder / folder).string());
  }
  Texts words = arguments_of(run);
  words.emplace_back("--quiet");
  return words;
}

/// A suite while it is made.
class Making {
 public:
  Making(const SuiteRequest& request, Caller& caller) : request_(request), caller_(caller) {}

  SuiteMade made() {
    plan();
    std::string recorded;
    if (!request_.recorded.empty()) {
      recorded =
          fmt::format("{}, {}", request_.recorded, suite::read_suite(request_.recorded).version);
    }
    provenance_ = files::provenance_of(facts_of(request_, planned_));
    const std::optional<suite::SuiteResult> baseline = baseline_of(request_.place);
    note_longer(request_.place.out, request_.place.is_named(), "runs",
                provenance_.facts.at("runs").get<std::size_t>(), caller_);
    files::Output folder(request_.place.out, suite::suite_files(), files::Unfinished::kept);
    begin(folder, provenance_, request_);
    try {
      std::vector<suite::SuiteResult> others =
          is_sequential(baseline) ? run_looks(folder, *baseline) : run_all(folder);
      suite::SuiteResult own = std::move(others.front());
      others.erase(others.begin());
      caller_.wipe();
      own.recorded = recorded;
      write_how_made(folder, request_, provenance_);
      if (of_worlds(request_)) write_sheets(folder.staging(), now_, own, caller_);
      return finish_suite(folder, request_.place, std::move(own), std::move(others), baseline,
                          caller_);
    } catch (const Interrupted&) {
      caller_.wipe();
      if (whole_ == 0) throw;
      throw Interrupted(fmt::format(
          "interrupted; {} of {} runs are kept, and the same command goes on from there", whole_,
          total_));
    }
  }

 private:
  /// Checks the request, and warns of likely mistakes.
  void plan() {
    const comparators::DetectorSpec spec = app::spec_of(request_.detector);
    own_ = spec.name;
    const std::set<std::string> watching = names_of_all(request_, own_);
    if (!request_.recorded.empty()) comparators::require_corners_suffice(spec);
    planned_ = plan_suite(request_, caller_);
    now_ = planned_.plan;
    if (!request_.detector.detections.empty()) {
      require_detections(request_.detector.detections, planned_);
    }
    caller_.warn(seldom_meant(planned_.plan, spec));
    caller_.warn(scoring::not_asked(criteria_of(planned_.plan), watching));
  }

  /// Where the runs of each detector go. Runs of which only the figures are kept are no part of the
  /// result, and stay until it is committed.
  std::vector<suite::SuiteDetector> detectors_in(files::Output& folder,
                                                 const std::vector<std::string>& names) const {
    const bool are_kept = request_.keep != output::Keep::figures;
    std::vector<suite::SuiteDetector> all;
    for (const std::string& name : names) {
      const fs::path part = part_of(name, own_);
      all.push_back({name, (are_kept ? folder.staging() : folder.work()) / part, name == own_});
      fs::create_directories(all.back().folder);
      fs::create_directories(folder.staging() / part);
    }
    return all;
  }

  std::vector<suite::SuiteResult> run(files::Output& folder,
                                      const std::vector<std::string>& detectors,
                                      const fs::path& recordings) {
    std::vector<suite::SuiteResult> results = suite::run_suite(
        now_,
        {.detectors = detectors_in(folder, detectors),
         .run_of =
             [&](const auto& planned, std::uint64_t seed, const auto& detector) {
               return arguments_of(run_of(request_, planned, seed, detector, recordings));
             },
         .child_of =
             [&](const auto& planned, std::uint64_t seed, const auto& all) {
               return child_of(request_, planned, seed, all, recordings);
             },
         .sets = request_.sets,
         .version = version_line(),
         .jobs = jobs_at_once(request_.jobs),
         .former = former_suite(folder.target() / part_of(detectors.front(), own_)),
         .provenance = provenance_,
         .on_begin =
             [&](std::size_t there) {
               if (std::exchange(whole_, there) > 0 || there == 0) return;
               caller_.note(fmt::format("going on, with {} of the runs there already", there));
             },
         .on_result = [&] { folder.keep(); },
         .on_run =
             [&](const auto& done, const std::string& scenario, const auto& runs) {
               whole_ = done.done;
               total_ = done.total;
               caller_.finished(done, scenario, detectors, runs);
             },
         .on_tick =
             [&](const suite::SuiteProgress& now) {
               total_ = now.total;
               caller_.check();
               caller_.show(now);
             }});
    caller_.check();
    for (suite::SuiteResult& result : results) {
      if (request_.keep == output::Keep::figures) forget_folders(result);
      result.part_of = planned_.part_of;
      if (!of_worlds(request_)) continue;
      result.split = request_.worlds.split;
      add_origins(result);
    }
    return results;
  }

  /// The results, the own detector's first. Detectors that need pictures cannot use a recording:
  /// they simulate in runs of their own.
  std::vector<suite::SuiteResult> run_all(files::Output& folder) {
    std::vector<std::string> beside_own{own_}, apart;
    for (const std::string& name : request_.beside) {
      const bool looks = comparators::spec_of(name).detector.sees_pictures;
      (looks && !request_.recorded.empty() ? apart : beside_own).push_back(name);
    }
    std::vector<suite::SuiteResult> all = run(folder, beside_own, request_.recorded);
    if (!apart.empty()) std::ranges::move(run(folder, apart, ""), std::back_inserter(all));
    for (std::size_t i = 1; i < all.size(); ++i) all[0].beside.push_back(all[i].detector);
    return all;
  }

  /// Whether the verdict may end the suite early: if all runs of the baseline are planned.
  bool is_sequential(const std::optional<suite::SuiteResult>& baseline) const {
    if (!baseline || request_.all || planned_.part_of) return false;
    std::set<suite::RunName> planned;
    for (const suite::PlannedScenario& one : planned_.plan) {
      for (const std::uint64_t seed : one.seeds) planned.emplace(one.name, seed);
    }
    if (suite::looks_of(planned.size()).size() < 2) return false;
    return request_.place.allow_missing ||
           std::ranges::all_of(baseline->scenarios, [&](const suite::ScenarioResult& scenario) {
             return std::ranges::all_of(scenario.runs, [&](const suite::RunResult& run) {
               return planned.contains({scenario.name, run.seed});
             });
           });
  }

  /// Makes the runs up to each look, until the verdict is certain.
  std::vector<suite::SuiteResult> run_looks(files::Output& folder,
                                            const suite::SuiteResult& baseline) {
    std::vector<suite::Planned> planned;
    for (const suite::PlannedScenario& one : planned_.plan) {
      const bool is_world = one.scenario && one.scenario->origin;
      planned.push_back({one.name, is_world ? one.scenario->origin->family : "", one.seeds});
    }
    const std::vector<suite::RunName> order = suite::order_of(planned, baseline);
    const std::vector<suite::Look> looks = suite::looks_of(order.size());
    for (std::size_t k = 0;; ++k) {
      now_ = planned_.plan;
      const auto end = order.begin() + static_cast<std::ptrdiff_t>(looks[k].runs);
      suite::keep_runs(now_, {order.begin(), end});
      std::vector<suite::SuiteResult> results = run_all(folder);
      for (suite::SuiteResult& result : results) result.sequential = {looks[k], order.size()};
      const suite::Comparison comparison =
          suite::compare(baseline, results.front(), [](std::string_view) { return true; });
      if (k + 1 == looks.size() || suite::is_certain(comparison, looks, k)) return results;
      caller_.note(fmt::format("after {} of {} runs the verdict is not certain yet", looks[k].runs,
                               order.size()));
    }
  }

  const SuiteRequest& request_;
  Caller& caller_;
  std::string own_;  ///< name of the suite's own detector
  SuitePlan planned_;
  std::vector<suite::PlannedScenario> now_;  ///< the runs to make now
  files::Provenance provenance_;
  std::size_t whole_ = 0, total_ = 0;  ///< runs
};

}  // namespace

SuitePlan plan_suite(const SuiteRequest& request, Caller& caller) {
  std::optional<suite::SuiteResult> times;
  if (!request.times.empty()) times = suite::read_suite(request.times);
  const int seeds = request.seeds.value_or(of_worlds(request) ? 1 : 3);
  return of_worlds(request) ? plan_worlds(request, seeds, times, caller)
                            : plan_scenarios(request, seeds, times);
}

SuiteMade suite(const SuiteRequest& request, Caller& caller) {
  return Making(request, caller).made();
}

}  // namespace lcs::app
