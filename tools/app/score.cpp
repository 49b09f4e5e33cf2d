#include "tools/app/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tools/files/output.h"
#include "tools/recording/detections.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/figures_file.h"

namespace lcs::app {
namespace {

/// \throws std::runtime_error that names a run in the folder, if it is none itself.
void refuse_folder_of_runs(const std::filesystem::path& folder) {
  constexpr int kDeepest = 3;  // SUITE/runs/NAME/seed-N
  const auto is_run = [](const std::filesystem::path& one) {
    return std::filesystem::exists(recording::stored(one, recording::kLayersFile));
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

/// A run's frames with their times.
class StoredRun {
 public:
  explicit StoredRun(const std::filesystem::path& folder) : frames_(checked(folder)) {
    // The file is optional; without it the frames have no times.
    if (std::filesystem::exists(folder / scoring::kFramesFile)) {
      times_.emplace(folder / scoring::kFramesFile);
    }
  }

  const recording::RunInfo& info() const { return frames_.run(); }

  template <class Use>
  void for_each(const Use& use) {
    for (recording::FrameRecord frame; frames_.next(frame);) {
      if (times_) times_->read(frame);
      use(frame);
    }
    if (times_) times_->finish();
  }

  scoring::Metrics score() {
    scoring::Scorer scorer(info());
    for_each([&](const recording::FrameRecord& frame) { scorer.add(frame); });
    return scorer.metrics(info().warnings);
  }

 private:
  static const std::filesystem::path& checked(const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder)) {
      throw std::runtime_error(
          fmt::format("{} is no folder; name one that lcs run has left", folder.string()));
    }
    refuse_folder_of_runs(folder);
    return folder;
  }

  recording::RecordingReader frames_;
  std::optional<scoring::TimesReader> times_;
};

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
        run.metrics = StoredRun(folder / run.folder).score();
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
  StoredRun stored(request.sequence);
  std::optional<recording::Detections> detections;
  if (!request.detections.empty()) {
    recording::Recording whole{stored.info(), {}};
    stored.for_each([&](const recording::FrameRecord& frame) { whole.frames.push_back(frame); });
    detections = recording::read_detections(request.detections, std::move(whole));
    for (const std::string& line : recording::lines_of(detections->counts)) caller.tell(line);
  }
  std::vector<files::Output*> outputs;
  std::optional<files::Output> figures, verdicts;
  const auto add = [&](std::optional<files::Output>& output, const std::string& file) {
    if (!file.empty()) outputs.push_back(&output.emplace(file, files::overwrite(request.force)));
  };
  add(figures, request.out);
  add(verdicts, request.write_detections);
  Scored scored{.run = detections ? detections->recording : stored.info()};
  scoring::Scorer scorer(scored.run);
  std::optional<recording::DetectionsWriter> writer;
  if (verdicts) writer.emplace(verdicts->staging(), scored.run);
  const auto take = [&](const recording::FrameRecord& frame) {
    scorer.add(frame);
    if (writer) writer->write(frame);
  };
  if (detections) {
    std::ranges::for_each(detections->recording.frames, take);
  } else {
    stored.for_each(take);
  }
  scored.frames = scorer.frames();
  scored.metrics = scorer.metrics(scored.run.warnings);
  caller.check();
  if (figures) scoring::write_metrics(figures->staging(), scored.metrics);
  if (writer) writer->close();
  files::commit_all(outputs);
  return scored;
}

}  // namespace lcs::app
