#include "tools/output/result.h"

#include <algorithm>
#include <stdexcept>

#include "tools/output/event_pictures.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/score_rebels.h"

namespace lcs::bench {
Keep keep_of(const std::string& word) {
  const auto found = std::ranges::find(kKeepWords, word);
  if (found == kKeepWords.end()) {
    throw std::invalid_argument("--keep is '" + word + "'; it takes figures, events or all");
  }
  return static_cast<Keep>(found - kKeepWords.begin());
}

ResultNames result_files() {
  const std::string compressed = ".gz";
  return {kMetricsFile,  kFramesFile,
          kLayersFile,   kLayersFile + compressed,
          kTruthFile,    kTruthFile + compressed,
          kDetectorFile, kCameraFile,
          kWarningsFile, kVideoFile,
          kEventsFile,   kPicturesFile,
          "report.html", kHowMadeFile};
}

Result::Result(const std::filesystem::path& target, const RunInfo& run, cv::Size image_px,
               const ResultOptions& options)
    : folder_(target, result_files()),
      keep_(options.keep),
      image_px_(image_px),
      scorer_(run),
      painter_(image_px, run),
      show_(options.show),
      kept_(options.kept),
      add_page_(options.add_page) {
  const std::filesystem::path& folder = folder_.staging();
  if (keep_ != Keep::figures) rows_.emplace(folder / kFramesFile, run);
  if (options.events) events_.emplace(run);
  if (keep_ == Keep::all || events_) {  // the events' pictures are painted from them at the end
    writer_.emplace(folder, run, options.compressed, !options.is_truth_there);
  }
  if (options.video_frames_per_second) {
    video_.emplace(folder / kVideoFile, painter_.size_px(), *options.video_frames_per_second);
  }
}

void Result::add(const FrameRecord& frame, const cv::Mat3b& image) {
  const FrameScore score = scorer_.add(frame);
  if (rows_) rows_->write(frame, score.rebels);
  if (events_) {
    events_->add(frame, score.outcomes);
    if (held_.size() < kMostHeld) held_.push_back(frame);
  }
  if (writer_) writer_->write(frame);
  if (video_ || show_) {
    const cv::Mat3b sheet = painter_.paint(frame, image);
    if (video_) video_->write(sheet);
    if (show_ && !show_(sheet)) show_ = {};
  }
  if (events_ && !kept_ && !image.empty()) {
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
  const FramePictures* const pictures = kept_ ? kept_ : own ? &*own : nullptr;
  std::vector<Event> events = events_->events(scorer_.detections());
  const EventSums sums = sums_of(events);
  keep_worst(events, kMostEvents);
  if (pictures && pictures->size() > 0) {
    std::optional<RecordingReader> frames;
    int next = 0;
    for (const int shown : frames_shown(events)) {
      FrameRecord frame;
      if (static_cast<std::size_t>(shown) < held_.size()) {
        frame = std::move(held_[static_cast<std::size_t>(shown)]);
      } else {
        if (!frames) frames.emplace(folder);
        for (; next < shown; ++next) frames->skip();
        frames->next(frame);
        ++next;
      }
      paint_views(frame, corner_outcomes(frame, scorer_.detections()), *pictures, events);
    }
    if (keep_ == Keep::all && kept_) kept_->copy_to(folder / kPicturesFile);
  }
  write_events(folder / kEventsFile, events, sums);
  if (keep_ == Keep::all) return;
  for (const std::filesystem::path& file :
       {stored(folder, kLayersFile), stored(folder, kTruthFile), folder / kDetectorFile,
        folder / kCameraFile, folder / kPicturesFile}) {
    std::filesystem::remove(file);
  }
}

Metrics Result::finish(const std::optional<sim::Warnings>& world) {
  if (writer_) writer_->close();
  if (video_) video_->close();
  if (rows_) rows_->close();
  const std::filesystem::path& folder = folder_.staging();
  Metrics metrics = scorer_.metrics(world);
  warned_ = scorer_.warned(world);
  write_metrics(folder / kMetricsFile, metrics);
  if (world) write_warnings(folder / kWarningsFile, warned_);
  if (events_) write_events_file();
  if (add_page_) add_page_(folder, metrics);
  return metrics;
}

void Result::copy_truth(const std::filesystem::path& folder) {
  if (!writer_) return;
  const std::filesystem::path theirs = stored(folder, kTruthFile);
  copy_bytes(theirs, folder_.staging() / theirs.filename());
}

void Result::share_truth(const Result& other) {
  if (!writer_ || !other.writer_) return;
  const std::filesystem::path theirs = stored(other.folder_.staging(), kTruthFile);
  link_or_copy(theirs, folder_.staging() / theirs.filename());
}

}  // namespace lcs::bench
