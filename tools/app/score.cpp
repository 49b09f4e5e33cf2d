#include "tools/app/score.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tools/recording/detections.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/figures_file.h"

namespace lcs::app {
namespace {

/// \throws std::runtime_error that names a run in the folder, if it is none itself.
void refuse_folder_of_runs(const std::filesystem::path& folder) {
  constexpr int kDeepest = 3;  // SUITE/runs/NAME/seed-N
  const auto is_run = [](const std::filesystem::path& one) {
    return std::filesystem::exists(bench::stored(one, bench::kLayersFile));
  };
  if (is_run(folder)) return;
  std::filesystem::recursive_directory_iterator entries(folder), end;
  for (; entries != end; ++entries) {
    if (entries.depth() + 1 >= kDeepest) entries.disable_recursion_pending();
    if (!entries->is_directory() || !is_run(entries->path())) continue;
    throw std::runtime_error(
        fmt::format("{} is a folder of runs, as {}; name one of these, or the folder of a suite, "
                    "with its suite.json, to have all of its runs scored",
                    folder.string(), entries->path().string()));
  }
}

bench::Recording read_run(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw std::runtime_error(
        fmt::format("{} is no folder; name one that lcs run has left", folder.string()));
  }
  refuse_folder_of_runs(folder);
  bench::Recording recording = bench::read_recording(folder);
  // The file is optional; without it the recording has no times.
  const std::filesystem::path frames_csv = folder / bench::kFramesFile;
  if (std::filesystem::exists(frames_csv)) bench::read_times(frames_csv, recording);
  return recording;
}

/// Scores every run of a suite again.
suite::SuiteResult score_suite(const ScoreRequest& request, Caller& caller) {
  if (!request.detections.empty() || !request.out.empty() || !request.write_detections.empty()) {
    throw std::invalid_argument(fmt::format(
        "{0} is a suite, of which figures are only printed; for detections there is lcs suite "
        "--recorded {0} --detections DIR, or name a run in its runs/",
        request.sequence));
  }
  const std::filesystem::path folder = request.sequence;
  suite::SuiteResult suite = suite::read_suite(folder);
  for (suite::ScenarioResult& scenario : suite.scenarios) {
    for (suite::RunResult& run : scenario.runs) {
      caller.check();
      if (run.outcome != suite::Outcome::error) {
        run.metrics = bench::score(read_run(folder / run.folder));
      }
    }
  }
  return suite;
}

}  // namespace

Scored score(const ScoreRequest& request, Caller& caller) {
  if (std::filesystem::exists(std::filesystem::path(request.sequence) / suite::kSuiteFile)) {
    return {.suite = score_suite(request, caller)};
  }
  bench::Recording recording = read_run(request.sequence);
  if (!request.detections.empty()) {
    bench::Detections detections = bench::read_detections(request.detections, recording);
    for (const std::string& line : bench::lines_of(detections.counts)) caller.tell(line);
    recording = std::move(detections.recording);
  }
  std::vector<bench::Output*> outputs;
  std::optional<bench::Output> figures, verdicts;
  const auto add = [&](std::optional<bench::Output>& output, const std::string& file) {
    if (!file.empty()) outputs.push_back(&output.emplace(file, request.overwrite));
  };
  add(figures, request.out);
  add(verdicts, request.write_detections);
  bench::Metrics metrics = bench::score(recording);
  caller.check();
  if (figures) bench::write_metrics(figures->staging(), metrics);
  if (verdicts) bench::write_detections(verdicts->staging(), recording);
  bench::commit_all(outputs);
  return {.recording = std::move(recording), .metrics = std::move(metrics)};
}

}  // namespace lcs::app
