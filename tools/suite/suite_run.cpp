#include "tools/suite/suite_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "tools/input/message.h"
#include "tools/output/result.h"
#include "tools/scoring/criteria.h"
#include "tools/scoring/figures_file.h"
#include "tools/suite/beside_table.h"
#include "tools/suite/child_process.h"
#include "tools/suite/junit.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

namespace fs = std::filesystem;

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
  for (const char c : word) {
    if (c == '\'')
      text += R"('\'')";
    else
      text += c;
  }
  return text + "'";
}

fs::path folder_of(const PlannedScenario& planned, std::uint64_t seed) {
  return fs::path("runs") / planned.name / fmt::format("seed-{}", seed);
}

/// The arguments of a run without its outputs. \param is_own whether it is the suite's detector.
std::vector<std::string> run_of(const PlannedScenario& planned, std::uint64_t seed,
                                const std::string& detector, bool is_own,
                                const SuiteRunOptions& options) {
  std::vector<std::string> command{"run", planned.file.string(), "--seed", std::to_string(seed)};
  for (const std::string& set : planned.sets) command.insert(command.end(), {"--set", set});
  if (detector != "lcs") command.insert(command.end(), {"--detector", detector});
  if (!options.recorded.empty()) {
    command.insert(command.end(),
                   {"--recorded", (options.recorded / folder_of(planned, seed)).string()});
  }
  if (!is_own) return command;
  command.insert(command.end(), options.own_detector.begin(), options.own_detector.end());
  if (!options.detections.empty()) {
    command.insert(
        command.end(),
        {"--detections", (options.detections / detections_of(planned.name, seed)).string()});
  }
  return command;
}

/// The arguments of a child: the first watcher's run, with the others in `--beside`.
std::vector<std::string> command_of(const PlannedScenario& planned, std::uint64_t seed,
                                    const SuiteRunOptions& options) {
  const SuiteWatcher& first = options.watchers.front();
  std::vector<std::string> command = run_of(planned, seed, first.detector, first.is_own, options);
  command.insert(command.end(), {"--out", (first.folder / folder_of(planned, seed)).string(),
                                 "--no-video", "--quiet", "--events"});
  for (std::size_t i = 1; i < options.watchers.size(); ++i) {
    const SuiteWatcher& other = options.watchers[i];
    const fs::path folder = other.folder / folder_of(planned, seed);
    command.insert(command.end(),
                   {"--beside", fmt::format("{}={}", other.detector, folder.string())});
  }
  return command;
}

std::optional<double> former_seconds(const std::optional<SuiteResult>& former,
                                     const std::string& name, std::uint64_t seed) {
  const ScenarioResult* scenario = former ? find(*former, name) : nullptr;
  const RunResult* run = scenario ? find(*scenario, seed) : nullptr;
  return run && run->outcome != Outcome::error ? std::optional(run->wall_s) : std::nullopt;
}

/// All runs, longest first, so that the processors are busy until shortly before the end.
std::vector<Job> jobs_of(const std::vector<PlannedScenario>& plan,
                         const std::optional<SuiteResult>& former) {
  std::vector<Job> jobs;
  std::vector<bool> is_known;
  double known_seconds = 0, known_work = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (!plan[i].scenario) continue;
    for (std::size_t k = 0; k < plan[i].seeds.size(); ++k) {
      const auto seconds = former_seconds(former, plan[i].name, plan[i].seeds[k]);
      jobs.push_back({i, k, seconds.value_or(work(*plan[i].scenario))});
      is_known.push_back(seconds.has_value());
      if (!seconds) continue;
      known_seconds += *seconds;
      known_work += work(*plan[i].scenario);
    }
  }
  const double seconds_per_work = known_work > 0 ? known_seconds / known_work : kSecondsPerWork;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    if (!is_known[j]) jobs[j].seconds *= seconds_per_work;
  }
  std::stable_sort(jobs.begin(), jobs.end(),
                   [](const Job& a, const Job& b) { return a.seconds > b.seconds; });
  return jobs;
}

ScenarioResult begin_scenario(const PlannedScenario& planned, const SuiteWatcher& watcher,
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
    run.command = shell_line(run_of(planned, seed, watcher.detector, watcher.is_own, options));
    run.error = planned.error;
  }
  return result;
}

void finish_run(const PlannedScenario& planned, const Exit& exit, const SuiteWatcher& watcher,
                RunResult& run) {
  run.wall_s = exit.wall_s;
  const bool has_figures = exit.signal == 0 && (exit.code == 0 || exit.code == 1);
  if (!has_figures) {
    run.error = complaint_of(exit);
    bench::remove_abandoned(watcher.folder / folder_of(planned, run.seed), bench::result_files());
    return;
  }
  run.folder = folder_of(planned, run.seed);
  try {
    run.metrics = bench::read_metrics(watcher.folder / run.folder / bench::kMetricsFile);
    const fs::path warnings = watcher.folder / run.folder / bench::kWarningsFile;
    if (fs::exists(warnings)) run.warnings = bench::read_warnings(warnings);
    std::erase_if(run.warnings, [](const bench::Warned& w) { return w.count.value_or(0) == 0; });
    run.outcome = Outcome::passed;
    judge_run(bench::asked_of(watcher.detector, watcher.is_own, planned.scenario->criteria), run);
  } catch (const std::exception& error) {
    run.outcome = Outcome::error;
    run.error = input::message_of(error);
  }
}

}  // namespace

bench::ResultNames suite_files() {
  bench::ResultNames names{kSuiteFile,
                           kJunitFile,
                           "report.html",
                           "worlds.html",
                           "worlds/*.jpg",
                           kStandingFile,
                           std::string("beside/*/") + kSuiteFile};
  for (const std::string& file : bench::result_files()) {
    for (const char* suite : {"", "beside/*/"}) {
      names.push_back(fmt::format("{}runs/*/seed-*/{}", suite, file));
    }
  }
  return names;
}

fs::path detections_of(const std::string& scenario, std::uint64_t seed) {
  return fs::path(scenario) / fmt::format("seed-{}.csv", seed);
}

std::string shell_line(const std::vector<std::string>& arguments) {
  std::string line = "lcs";
  for (const std::string& word : arguments) line += ' ' + quoted(word);
  return line;
}

void judge_run(const std::vector<scenario::Criterion>& criteria, RunResult& run) {
  run.criteria = bench::judge(criteria, run.metrics);
  for (const bench::JudgedCriterion& one : run.criteria) {
    if (one.required && !one.met) run.outcome = Outcome::failed;
  }
}

std::vector<SuiteResult> run_suite(const std::vector<PlannedScenario>& plan,
                                   const SuiteRunOptions& options) {
  std::vector<SuiteResult> suites;
  for (const SuiteWatcher& watcher : options.watchers) {
    SuiteResult& suite = suites.emplace_back();
    suite.detector = watcher.detector;
    suite.sets = options.sets;
    suite.version = options.version;
    for (const PlannedScenario& planned : plan) {
      suite.scenarios.push_back(begin_scenario(planned, watcher, options));
    }
  }

  const std::vector<Job> jobs = jobs_of(plan, options.former);
  std::vector<std::vector<std::string>> commands;
  for (const Job& job : jobs) {
    const PlannedScenario& planned = plan[job.scenario];
    // Not in the children, because a child may remove an empty folder that another one needs.
    for (const SuiteWatcher& watcher : options.watchers) {
      fs::create_directories(watcher.folder / "runs" / planned.name);
    }
    commands.push_back(command_of(planned, planned.seeds[job.run], options));
  }

  SuiteProgress progress;
  progress.total = jobs.size();
  const double all_seconds = std::accumulate(
      jobs.begin(), jobs.end(), 0.0, [](double sum, const Job& job) { return sum + job.seconds; });
  double done_seconds = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto on_exit = [&](std::size_t place, const Exit& exit) {
    const Job& job = jobs[place];
    std::vector<const RunResult*> finished;
    for (std::size_t i = 0; i < suites.size(); ++i) {
      RunResult& run = suites[i].scenarios[job.scenario].runs[job.run];
      finish_run(plan[job.scenario], exit, options.watchers[i], run);
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

  std::error_code ignored;  // removes folders of scenarios without any result
  for (const SuiteWatcher& watcher : options.watchers) {
    for (const PlannedScenario& planned : plan) {
      fs::remove(watcher.folder / "runs" / planned.name, ignored);
    }
  }
  return suites;
}

}  // namespace lcs::suite
