#include "tools/output/result.h"

#include <algorithm>
#include <stdexcept>

#include "tools/output/event_pictures.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/score_rebels.h"

namespace lcs::output {
Keep keep_of(const std::string& word) {
  const auto found = std::ranges::find(kKeepWords, word);
  if (found == kKeepWords.end()) {
    throw std::invalid_argument("--keep is '" + word + "'; it takes figures, events or all");
  }
  return static_cast<Keep>(found - kKeepWords.begin());
}

files::ResultNames result_files() {
  const std::string compressed = ".gz";
  return {scoring::kMetricsFile,
          scoring::kFramesFile,
          recording::kLayersFile,
          recording::kLayersFile + compressed,
          recording::kTruthFile,
          recording::kTruthFile + compressed,
          recording::kDetectorFile,
          recording::kCameraFile,
          recording::kWarningsFile,
          kVideoFile,
          scoring::kEventsFile,
          kPicturesFile,
          "report.html",
          files::kHowMadeFile};
}

Result::Result(const std::filesystem::path& target, const recording::RunInfo& run,
               cv::Size image_px, const ResultOptions& options)
    : folder_(target, result_files()),
      options_(options),
      image_px_(image_px),
      scorer_(run),
      run_(run),
      sheet_(image_px) {
  const std::filesystem::path& folder = folder_.staging();
  if (options_.keep != Keep::figures) rows_.emplace(folder / scoring::kFramesFile, run);
  if (options.events) events_.emplace(run);
  if (options_.keep == Keep::all ||
      events_) {  // the events' pictures are painted from them at the end
    writer_.emplace(folder, run, options.compressed, !options.is_truth_there);
  }
  if (options.video_frames_per_second) {
    video_.emplace(folder / kVideoFile, sheet_.size_px(), *options.video_frames_per_second);
  }
}

void Result::add(const recording::FrameRecord& frame, const cv::Mat3b& image) {
  const scoring::FrameScore score = scorer_.add(frame);
  if (rows_) rows_->write(frame, score.rebels);
  if (events_) {
    events_->add(frame, score.outcomes);
    if (held_.size() < kMostHeld) held_.push_back(frame);
  }
  if (writer_) writer_->write(frame);
  if (video_ || options_.show) {
    const cv::Mat3b sheet = painted(sheet_, run_, frame, image);
    if (video_) video_->write(sheet);
    if (options_.show && !options_.show(sheet)) options_.show = {};
  }
  if (events_ && !options_.kept && !image.empty()) {
    if (!own_pictures_) own_pictures_.emplace(folder_.staging() / kPicturesFile);
    own_pictures_->write(image);
  }
}

/// Writes the events with their pictures, and removes what was only kept for these.
void Result::write_events_file() {
  const std::filesystem::path& folder = folder_.staging();
  std::optional<FramePictures> own;
  if (own_pictures_) {
    own_pictures_->close();
    own.emplace(folder / kPicturesFile, image_px_);
  }
  const FramePictures* const pictures = options_.kept ? options_.kept : own ? &*own : nullptr;
  std::vector<scoring::ScoredEvent> events = events_->events(scorer_.detections());
  const scoring::EventSums sums = scoring::sums_of(events);
  scoring::keep_worst(events, scoring::kMostEvents);
  if (pictures && pictures->size() > 0) {
    std::optional<recording::RecordingReader> frames;
    int next = 0;
    for (const int shown : frames_shown(events)) {
      recording::FrameRecord frame;
      if (static_cast<std::size_t>(shown) < held_.size()) {
        frame = std::move(held_[static_cast<std::size_t>(shown)]);
      } else {
        if (!frames) frames.emplace(folder);
        for (; next < shown; ++next) frames->skip();
        frames->next(frame);
        ++next;
      }
      paint_views(frame, scoring::corner_outcomes(frame, scorer_.detections()), *pictures, events);
    }
    if (options_.keep == Keep::all && options_.kept)
      files::copy_bytes(options_.kept->path(), folder / kPicturesFile);
  }
  scoring::write_events(folder / scoring::kEventsFile, events, sums);
  if (options_.keep == Keep::all) return;
  for (const std::filesystem::path& file :
       {recording::stored(folder, recording::kLayersFile),
        recording::stored(folder, recording::kTruthFile), folder / recording::kDetectorFile,
        folder / recording::kCameraFile, folder / kPicturesFile}) {
    std::filesystem::remove(file);
  }
}

scoring::Metrics Result::finish(const std::optional<sim::Warnings>& world) {
  if (writer_) writer_->close();
  if (video_) video_->close();
  if (rows_) rows_->close();
  const std::filesystem::path& folder = folder_.staging();
  scoring::Metrics metrics = scorer_.metrics(world);
  warned_ = scorer_.warned(world);
  scoring::write_metrics(folder / scoring::kMetricsFile, metrics);
  if (world) recording::write_warnings(folder / recording::kWarningsFile, warned_);
  if (events_) write_events_file();
  if (options_.add_page) options_.add_page(folder, metrics);
  return metrics;
}

void Result::copy_truth(const std::filesystem::path& folder) {
  if (!writer_) return;
  const std::filesystem::path theirs = recording::stored(folder, recording::kTruthFile);
  files::copy_bytes(theirs, folder_.staging() / theirs.filename());
}

void Result::share_truth(const Result& other) {
  if (!writer_ || !other.writer_) return;
  const std::filesystem::path theirs =
      recording::stored(other.folder_.staging(), recording::kTruthFile);
  files::link_or_copy(theirs, folder_.staging() / theirs.filename());
}

}  // namespace lcs::output
