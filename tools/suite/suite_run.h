/// \file
/// A suite's plan carried out: every run in a process of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/files/output.h"
#include "tools/suite/plan.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// All files that a suite's folder may hold: its own, and in beside/NAME/ those of the same suite
/// with other detectors.
bench::ResultNames suite_files();

/// What is told while runs are under way.
struct SuiteProgress {
  std::size_t done = 0, total = 0;   ///< runs
  std::vector<std::string> running;  ///< as "crossing seed 2"
  std::optional<double> left_s;      ///< none before the first has ended
};

/// A detector that is run, and where its results go.
struct SuiteWatcher {
  std::string detector;
  std::filesystem::path folder;  ///< gets runs/<name>/seed-<n>/
  bool is_own = true;            ///< the suite's, which criteria ask that name none
};

struct SuiteRunOptions {
  /// At least one: all watch the same frames, which are made once. The first keeps pictures and
  /// events.
  std::vector<SuiteWatcher> watchers;
  std::vector<std::string> own_detector;  ///< options of `lcs run` for the first, its name apart
  /// Folder with what the first one says of each run, as `detections_of` has it; "": it is asked.
  std::filesystem::path detections = {};
  std::vector<std::string> sets;
  std::filesystem::path recorded;  ///< folder of an earlier suite, for its frames; "": simulate
  std::string version;
  std::size_t jobs = 1;               ///< runs at a time, >= 1
  std::optional<SuiteResult> former;  ///< whose times tell which runs are long
  /// Called when a run has ended, with what it came to for each watcher.
  std::function<void(const SuiteProgress&, const std::string& scenario,
                     std::span<const RunResult* const>)>
      on_run;
  /// Called some times a second. What it throws ends the suite and its children.
  std::function<void(const SuiteProgress&)> on_tick;
};

/// NAME/seed-N.csv
std::filesystem::path detections_of(const std::string& scenario, std::uint64_t seed);

/// A command of `lcs`, as a POSIX shell takes it.
std::string shell_line(const std::vector<std::string>& arguments);

/// Holds a run's figures against what is asked of its detector.
void judge_run(const std::vector<scenario::Criterion>& criteria, RunResult& run);

/// \return a result for each watcher.
std::vector<SuiteResult> run_suite(const std::vector<PlannedScenario>& plan,
                                   const SuiteRunOptions& options);

}  // namespace lcs::suite
