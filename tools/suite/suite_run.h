/// \file
/// Executes a suite's plan, every run in its own process.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/files/output.h"
#include "tools/files/provenance.h"
#include "tools/suite/plan.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// All files that a suite's folder may hold: its own files, and in beside/NAME/ the files of other
/// detectors.
files::ResultNames suite_files();

/// Progress of the runs.
struct SuiteProgress {
  std::size_t done = 0, total = 0;   ///< runs
  std::vector<std::string> running;  ///< such as "crossing seed 2"
  std::optional<double> left_s;      ///< estimate; absent until the first run ends
};

/// A detector and the folder of its results.
struct SuiteDetector {
  std::string detector;
  std::filesystem::path folder;  ///< gets `runs/<name>/seed-<n>/`
  bool is_own = true;            ///< the suite's detector; criteria without a detector apply to it
};

struct SuiteRunOptions {
  /// At least one. All process the same frames, which are made once. Only the first one writes
  /// pictures and events.
  std::vector<SuiteDetector> detectors;
  /// The arguments of `lcs` for a run with one of the detectors, without its outputs.
  std::function<std::vector<std::string>(const PlannedScenario&, std::uint64_t seed,
                                         const SuiteDetector&)>
      run_of;
  /// The arguments of `lcs` for the child that makes a run for all detectors.
  std::function<std::vector<std::string>(const PlannedScenario&, std::uint64_t seed,
                                         std::span<const SuiteDetector>)>
      child_of;
  std::vector<std::string> sets;
  std::string version;
  std::size_t jobs = 1;               ///< concurrent runs, >= 1
  std::optional<SuiteResult> former;  ///< earlier result, to estimate durations
  files::Provenance& provenance;      ///< of the suite; gets the files that the runs have read
  /// Called with the number of runs that an earlier process has finished.
  std::function<void(std::size_t)> on_begin;
  /// Called when a run of this process has left its result, before that is read.
  std::function<void()> on_result;
  /// Called when a run of this process ends, with its result for each detector.
  std::function<void(const SuiteProgress&, const std::string& scenario,
                     std::span<const RunResult* const>)>
      on_run;
  /// Called several times a second. An exception ends the suite and its children.
  std::function<void(const SuiteProgress&)> on_tick;
};

/// The duration of an earlier run in s; absent if it is unknown or ended with an error.
std::optional<double> former_seconds(const SuiteResult& former, const std::string& name,
                                     std::uint64_t seed);

/// The estimated duration of each planned run, in the order of the plan and its seeds, in s; 0 for
/// a broken scenario. \param former an earlier result with the durations of some runs.
std::vector<double> estimated_seconds(const std::vector<PlannedScenario>& plan,
                                      const std::optional<SuiteResult>& former);

/// The folder of a run in a detector's folder: runs/NAME/seed-N.
std::filesystem::path folder_of(const PlannedScenario& planned, std::uint64_t seed);

/// The file of a run's detections: NAME/seed-N.csv.
std::filesystem::path detections_of(const std::string& scenario, std::uint64_t seed);

/// A command of `lcs`, quoted for a POSIX shell.
std::string shell_line(const std::vector<std::string>& arguments);

/// Sets the run's criteria and outcome from its figures.
void judge_run(const std::vector<scenario::Criterion>& criteria, RunResult& run);

/// Runs all planned scenarios. Runs whose results are there already are not repeated.
/// \return a result for each detector. \throws std::runtime_error if such a run no longer fits, or
///   if two runs have read a file in different states. files::OutputError if the result of a run
///   cannot be written.
std::vector<SuiteResult> run_suite(const std::vector<PlannedScenario>& plan,
                                   const SuiteRunOptions& options);

}  // namespace lcs::suite
