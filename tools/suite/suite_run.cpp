#include "tools/suite/suite_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "tools/files/json_node.h"
#include "tools/files/written.h"
#include "tools/output/result.h"
#include "tools/scoring/criteria.h"
#include "tools/scoring/figures_file.h"
#include "tools/suite/child_process.h"
#include "tools/suite/summary.h"
#include "tools/suite/tables.h"

namespace lcs::suite {
namespace {

/// Rough estimate for runs without any known duration, in s.
constexpr double kSecondsPerWork = 1e-7;

/// One run: its indices in the plan and its estimated duration.
struct Job {
  std::size_t scenario, run;
  double seconds;
};

/// Quotes a word for a POSIX shell, if needed.
std::string quoted(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=:,@%+-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? R"('\'')" : std::string(1, c);
  return text + "'";
}

/// All runs, longest first, so that the processors are busy until shortly before the end.
std::vector<Job> jobs_of(const std::vector<PlannedScenario>& plan,
                         const std::optional<SuiteResult>& former) {
  const std::vector<double> seconds = estimated_seconds(plan, former);
  std::vector<Job> jobs;
  std::size_t next = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    for (std::size_t k = 0; k < plan[i].seeds.size(); ++k, ++next) {
      if (plan[i].scenario) jobs.push_back({i, k, seconds[next]});
    }
  }
  std::ranges::stable_sort(jobs, std::greater(), &Job::seconds);
  return jobs;
}

ScenarioResult begin_scenario(const PlannedScenario& planned, const SuiteDetector& detector,
                              const SuiteRunOptions& options) {
  ScenarioResult result;
  result.name = planned.name;
  result.file = planned.file;
  result.point = planned.point;
  if (planned.scenario) {
    result.purpose = planned.scenario->purpose;
    result.groups = planned.scenario->groups;
  }
  for (const std::uint64_t seed : planned.seeds) {
    RunResult& run = result.runs.emplace_back();
    run.seed = seed;
    run.command = shell_line(options.run_of(planned, seed, detector));
    run.error = planned.error;
  }
  return result;
}

/// Whether an earlier process has finished a run, for all detectors.
/// \throws std::runtime_error if its files are no longer as they were written, or those that it has
///   read are no longer as they were then.
bool is_whole(const PlannedScenario& planned, std::uint64_t seed,
              const std::vector<SuiteDetector>& detectors) {
  std::string what;
  for (const SuiteDetector& detector : detectors) {
    const fs::path folder = detector.folder / folder_of(planned, seed);
    if (!fs::exists(folder)) return false;
    what = files::first_difference(folder);
    if (what.empty()) what = files::changed_since(files::read_how_made(folder));
    if (what.empty()) continue;
    throw std::runtime_error(fmt::format(
        "{}: {}, so that this finished run no longer fits; remove its folder to have it made "
        "again, or give --anew to begin the suite again",
        folder.string(), what));
  }
  return true;
}

/// The duration of an earlier run, as its run.json states it; 0 if it has none.
double seconds_of(const fs::path& folder) {
  constexpr input::FileKind kKind{files::kMostJsonBytes, "run the suite again"};
  try {
    return files::read_json(folder / files::kHowMadeFile, kKind, [](const files::JsonNode& node) {
      return node["wall_s"].figure().value_or(0);
    });
  } catch (const std::exception&) {
    return 0;
  }
}

/// Takes the figures of a run from its folder. \param exit absent for a run of an earlier process.
/// A file of a finished run that cannot be read ends the suite, which goes on when it can be.
/// \param provenance of the suite, to which the files are added that the run has read.
void finish_run(const PlannedScenario& planned, const std::optional<Exit>& exit,
                const SuiteDetector& detector, RunResult& run, files::Provenance& provenance) {
  const fs::path folder = detector.folder / folder_of(planned, run.seed);
  run.wall_s = exit ? exit->wall_s : seconds_of(folder);
  if (exit && (exit->signal != 0 || exit->code < 0 || exit->code > 1)) {
    run.error = complaint_of(*exit);
    if (exit->code == kFaultyDisk) throw files::OutputError(run.error);
    files::remove_abandoned(folder, output::result_files());
    return;
  }
  run.folder = folder_of(planned, run.seed);
  files::remove_abandoned(folder, output::result_files());  // which it could not remove by itself
  provenance.add_read(files::read_how_made(folder),
                      fmt::format("{} seed {}", planned.name, run.seed));
  run.metrics = scoring::read_metrics(folder / scoring::kMetricsFile);
  const fs::path warnings = folder / recording::kWarningsFile;
  if (fs::exists(warnings)) run.warnings = recording::read_warnings(warnings);
  std::erase_if(run.warnings, [](const recording::Warned& w) { return w.count.value_or(0) == 0; });
  run.outcome = Outcome::passed;
  judge_run(scoring::asked_of(detector.detector, detector.is_own, planned.scenario->criteria), run);
}

}  // namespace

files::ResultNames suite_files() {
  files::ResultNames names{
      kSuiteFile,     kJunitFile,          "report.html", "worlds.html",
      "worlds/*.jpg", files::kHowMadeFile, kStandingFile, std::string("beside/*/") + kSuiteFile};
  for (const std::string& file : output::result_files()) {
    for (const char* suite : {"", "beside/*/"}) {
      names.push_back(fmt::format("{}runs/*/seed-*/{}", suite, file));
    }
  }
  return names;
}

fs::path folder_of(const PlannedScenario& planned, std::uint64_t seed) {
  return fs::path("runs") / planned.name / fmt::format("seed-{}", seed);
}

fs::path detections_of(const std::string& scenario, std::uint64_t seed) {
  return fs::path(scenario) / fmt::format("seed-{}.csv", seed);
}

std::optional<double> former_seconds(const SuiteResult& former, const std::string& name,
                                     std::uint64_t seed) {
  const ScenarioResult* scenario = find(former, name);
  const RunResult* run = scenario ? find(*scenario, seed) : nullptr;
  return run && run->outcome != Outcome::error ? std::optional(run->wall_s) : std::nullopt;
}

std::vector<double> estimated_seconds(const std::vector<PlannedScenario>& plan,
                                      const std::optional<SuiteResult>& former) {
  std::vector<double> seconds;
  std::vector<bool> is_known;
  double known_seconds = 0, known_work = 0;
  for (const PlannedScenario& planned : plan) {
    const double own_work = planned.scenario ? work(*planned.scenario) : 0;
    for (const std::uint64_t seed : planned.seeds) {
      const auto known = former ? former_seconds(*former, planned.name, seed) : std::nullopt;
      seconds.push_back(known.value_or(own_work));
      is_known.push_back(known.has_value());
      if (!known) continue;
      known_seconds += *known;
      known_work += own_work;
    }
  }
  const double seconds_per_work = known_work > 0 ? known_seconds / known_work : kSecondsPerWork;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    if (!is_known[i]) seconds[i] *= seconds_per_work;
  }
  return seconds;
}

std::string shell_line(const std::vector<std::string>& arguments) {
  std::string line = "lcs";
  for (const std::string& word : arguments) line += ' ' + quoted(word);
  return line;
}

void judge_run(const std::vector<scenario::Criterion>& criteria, RunResult& run) {
  run.criteria = scoring::judge(criteria, run.metrics);
  for (const scoring::JudgedCriterion& one : run.criteria) {
    if (one.required && !one.met) run.outcome = Outcome::failed;
  }
}

std::vector<SuiteResult> run_suite(const std::vector<PlannedScenario>& plan,
                                   const SuiteRunOptions& options) {
  std::vector<SuiteResult> suites;
  for (const SuiteDetector& detector : options.detectors) {
    SuiteResult& suite = suites.emplace_back();
    suite.detector = detector.detector;
    suite.sets = options.sets;
    suite.version = options.version;
    for (const PlannedScenario& planned : plan) {
      suite.scenarios.push_back(begin_scenario(planned, detector, options));
    }
  }

  std::vector<Job> jobs = jobs_of(plan, options.former);
  const std::size_t total = jobs.size();
  std::erase_if(jobs, [&](const Job& job) {
    const PlannedScenario& planned = plan[job.scenario];
    if (!is_whole(planned, planned.seeds[job.run], options.detectors)) return false;
    for (std::size_t i = 0; i < suites.size(); ++i) {
      finish_run(planned, std::nullopt, options.detectors[i],
                 suites[i].scenarios[job.scenario].runs[job.run], options.provenance);
    }
    return true;
  });
  options.on_begin(total - jobs.size());
  std::vector<std::vector<std::string>> commands;
  for (const Job& job : jobs) {
    const PlannedScenario& planned = plan[job.scenario];
    // Not in the children, because a child may remove an empty folder that another one needs.
    for (const SuiteDetector& detector : options.detectors) {
      fs::create_directories(detector.folder / "runs" / planned.name);
    }
    commands.push_back(options.child_of(planned, planned.seeds[job.run], options.detectors));
  }

  SuiteProgress progress{total - jobs.size(), total, {}, {}};
  const double all_seconds = std::accumulate(
      jobs.begin(), jobs.end(), 0.0, [](double sum, const Job& job) { return sum + job.seconds; });
  double done_seconds = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto on_exit = [&](std::size_t place, const Exit& exit) {
    const Job& job = jobs[place];
    const PlannedScenario& planned = plan[job.scenario];
    const fs::path result = folder_of(planned, planned.seeds[job.run]);
    if (fs::exists(options.detectors.front().folder / result)) options.on_result();
    std::vector<const RunResult*> finished;
    for (std::size_t i = 0; i < suites.size(); ++i) {
      RunResult& run = suites[i].scenarios[job.scenario].runs[job.run];
      finish_run(plan[job.scenario], exit, options.detectors[i], run, options.provenance);
      finished.push_back(&run);
    }
    done_seconds += job.seconds;
    const double took_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++progress.done;
    progress.left_s = took_s * (all_seconds - done_seconds) / done_seconds;
    options.on_run(progress, plan[job.scenario].name, finished);
  };
  const auto on_tick = [&](const std::vector<std::size_t>& running) {
    progress.running.clear();
    for (const std::size_t place : running) {
      const PlannedScenario& planned = plan[jobs[place].scenario];
      progress.running.push_back(
          fmt::format("{} seed {}", planned.name, planned.seeds[jobs[place].run]));
    }
    options.on_tick(progress);
  };
  run_all(commands, options.jobs, on_exit, on_tick);

  for (SuiteResult& suite : suites) std::ranges::for_each(suite.scenarios, judge_over_seeds);
  std::error_code ignored;  // removes folders of scenarios without any result
  for (const SuiteDetector& detector : options.detectors) {
    for (const PlannedScenario& planned : plan) {
      fs::remove(detector.folder / "runs" / planned.name, ignored);
    }
  }
  return suites;
}

}  // namespace lcs::suite
