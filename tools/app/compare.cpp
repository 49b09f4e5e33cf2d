#include "tools/app/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>

#include "tools/app/suite_end.h"
#include "tools/files/output.h"
#include "tools/recording/recording_io.h"
#include "tools/suite/merge_request.h"
#include "tools/suite/plan.h"

namespace lcs::app {
namespace fs = std::filesystem;

Compared compare(const CompareRequest& request) {
  const suite::Pattern wanted(request.metric, "--metric", "rebel.*f1");
  Compared compared{
      .before = suite::read_suite(request.before),
      .after = suite::read_suite(request.after),
      .warnings = other_inputs(suite::folder_of(request.before), suite::folder_of(request.after))};
  compared.comparison =
      suite::compare(compared.before, compared.after,
                     [&](std::string_view metric) { return wanted.is_in(metric); });
  if (request.allow_missing) compared.comparison.missing.clear();
  if (compared.comparison.scenarios.empty()) {
    throw std::runtime_error(
        fmt::format("{} and {} have no scenario in common; give two suites of the same scenarios",
                    request.before, request.after));
  }
  const bool is_text_asked = !request.markdown.empty();  // which shows the events
  const auto in_folder = [&](const suite::SuiteResult& suite, const std::string& named) {
    return suite::SuiteInFolder{suite, is_text_asked ? suite::folder_of(named) : ""};
  };
  const suite::SuiteInFolder before = in_folder(compared.before, request.before),
                             after = in_folder(compared.after, request.after);
  compared.verdict = suite::verdict_of(after, &before, &compared.comparison);
  if (is_text_asked) {
    files::Output folder(request.markdown,
                         {suite::kSummaryFile, suite::kBeforePicture, suite::kAfterPicture});
    suite::write_merge_request(folder.staging(), before, after, compared.comparison,
                               compared.verdict, request.pictures_at);
    folder.commit();
  }
  return compared;
}

namespace {

/// The folders of the runs in a suite that have figures, by their names; of a run, its own.
std::map<std::string, fs::path> runs_in(const std::string& path) {
  if (fs::exists(recording::stored(path, recording::kLayersFile))) return {{"", path}};
  std::map<std::string, fs::path> runs;
  for (const suite::ScenarioResult& scenario : suite::read_suite(path).scenarios) {
    for (const suite::RunResult& run : scenario.runs) {
      if (run.metrics.empty()) continue;
      const fs::path folder = suite::folder_of(path) / run.folder;
      if (run.folder.empty() || !fs::exists(recording::stored(folder, recording::kLayersFile))) {
        throw std::runtime_error(
            fmt::format("{} has no frames of {} seed {}; make it with --keep all", path,
                        scenario.name, run.seed));
      }
      runs.emplace(fmt::format("{} seed {}", scenario.name, run.seed), folder);
    }
  }
  return runs;
}

}  // namespace

ComparedFrames compare_frames(const std::string& before, const std::string& after) {
  const std::map<std::string, fs::path> was = runs_in(before), is = runs_in(after);
  ComparedFrames compared;
  for (const auto& [name, folder] : is) {
    if (!was.contains(name)) compared.missing.push_back(fmt::format("{}: only after", name));
  }
  for (const auto& [name, folder] : was) {
    const auto other = is.find(name);
    if (other == is.end()) {
      compared.missing.push_back(fmt::format("{}: only before", name));
      continue;
    }
    compared.runs.push_back(
        {name, folder, other->second, recording::difference_of(folder, other->second)});
  }
  if (compared.runs.empty()) {
    throw std::runtime_error(fmt::format(
        "{} and {} have no run in common; give two runs, or two suites of the same scenarios",
        before, after));
  }
  return compared;
}

std::string first_frame_text(const RunFrames& run, std::size_t most) {
  const auto& [frames, differing, first] = run.difference;
  std::string text = fmt::format(
      "{}frame {} (t = {:.3f} s) is the first of {} that differ, of {}, in {}\n",
      run.name.empty() ? "" : run.name + ": ", first->frame,
      static_cast<double>(first->t_ns) * 1e-9, differing, frames, fmt::join(first->what, ", "));
  const std::size_t shown = std::min(first->corners.size(), most);
  for (std::size_t i = 0; i < shown; ++i) {
    const auto& [place_px, before, after] = first->corners[i];
    text += fmt::format("  ({:g}, {:g}) px: {} -> {}\n", place_px.x(), place_px.y(), before, after);
  }
  const std::size_t left = first->corners.size() - shown;
  return left > 0 ? text + fmt::format("  and {} more corners\n", left) : text;
}

}  // namespace lcs::app
