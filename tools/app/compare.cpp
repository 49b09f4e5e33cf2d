#include "tools/app/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>

#include "sim/pictures/picture_file.h"
#include "tools/app/suite.h"
#include "tools/files/output.h"
#include "tools/output/frame_pictures.h"
#include "tools/output/result.h"
#include "tools/recording/recording_io.h"
#include "tools/suite/judgement.h"
#include "tools/suite/plan.h"
#include "tools/suite/tables.h"

namespace lcs::app {

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

/// Writes the panels of a frame of a run, on grey if the run kept no pictures.
void write_panels(const fs::path& run, const recording::FrameRecord& frame, const fs::path& file) {
  const recording::RunInfo info = recording::RecordingReader(run).run();
  if (!info.camera) throw std::runtime_error(fmt::format("{} has no camera.json", run.string()));
  const cv::Size size_px(info.camera->width_px, info.camera->height_px);
  cv::Mat3b image(size_px, cv::Vec3b(96, 96, 96));
  if (fs::exists(run / output::kPicturesFile)) {
    image = output::FramePictures(run / output::kPicturesFile, size_px)
                .image(static_cast<std::size_t>(frame.index));
  }
  const cv::Mat3b sheet = output::painted(output::PanelSheet(size_px), info, frame, image);
  files::write_file(file, sim::encode_jpeg(sheet, 85));
}

/// The summary of the first run that differs.
void write_summary(const CompareRequest& request, const ComparedFrames& compared) {
  files::Output folder(request.markdown,
                       {suite::kSummaryFile, suite::kBeforePicture, suite::kAfterPicture});
  std::string text = fmt::format("### {}\n", compared.line);
  const auto run = std::ranges::find_if(
      compared.runs, [](const RunFrames& each) { return each.difference.first.has_value(); });
  if (run != compared.runs.end()) {
    text += fmt::format("\n```\n{}```\n\n", first_frame_text(*run));
    const recording::FrameDifference& first = *run->difference.first;
    const auto picture = [&](const fs::path& run_folder, const char* name,
                             const std::optional<recording::FrameRecord>& frame) {
      if (!frame) return std::string("the run has ended");
      write_panels(run_folder, *frame, folder.staging() / name);
      return suite::picture_link(first.frame, name, request.pictures_at);
    };
    text += fmt::format("| before | after |\n|---|---|\n| {} | {} |\n",
                        picture(run->before, suite::kBeforePicture, first.before),
                        picture(run->after, suite::kAfterPicture, first.after));
  }
  files::write_file(folder.staging() / suite::kSummaryFile, text);
  folder.commit();
}

}  // namespace

ComparedFrames compare_frames(const CompareRequest& request) {
  const std::map<std::string, fs::path> was = runs_in(request.before), is = runs_in(request.after);
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
        request.before, request.after));
  }
  std::ptrdiff_t different = 0, frames = 0, differing = 0;
  for (const RunFrames& run : compared.runs) {
    different += run.difference.first.has_value();
    frames += run.difference.frames;
    differing += run.difference.differing;
  }
  compared.is_different = different > 0;
  compared.line = fmt::format(
      "{}: {} of {} differ, in {} of {}", compared.is_different ? "different" : "equal", different,
      suite::counted(std::ssize(compared.runs), "run"), differing, suite::counted(frames, "frame"));
  if (!request.markdown.empty()) write_summary(request, compared);
  return compared;
}

std::string first_frame_text(const RunFrames& run, std::size_t most) {
  const auto& [frames, differing, first] = run.difference;
  std::string text = fmt::format(
      "{}frame {} (t = {:.3f} s) is the first of {} that differ, of {}, in {}\n",
      run.name.empty() ? "" : run.name + ": ", first->frame,
      static_cast<double>(first->t_ns) * 1e-9, differing, frames, fmt::join(first->parts, ", "));
  const std::size_t shown = std::min(first->corners.size(), most);
  for (std::size_t i = 0; i < shown; ++i) {
    const auto& [place_px, before, after] = first->corners[i];
    text += fmt::format("  ({:g}, {:g}) px: {} -> {}\n", place_px.x(), place_px.y(), before, after);
  }
  const std::size_t left = first->corners.size() - shown;
  return left > 0 ? text + fmt::format("  and {} more corners\n", left) : text;
}

}  // namespace lcs::app
