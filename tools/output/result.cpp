#include "tools/output/result.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

#include "tools/output/event_pictures.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/figures_file.h"

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

Result::Result(const std::filesystem::path& target, const Recording& run, cv::Size image_px,
               const ResultOptions& options)
    : folder_(target, result_files()),
      keep_(options.keep),
      painter_(image_px, run),
      show_(options.show),
      events_(options.events),
      kept_(options.kept),
      add_page_(options.add_page) {
  if (keep_ == Keep::all) {
    writer_.emplace(folder_.staging(), run, options.compressed, !options.truth_of_other);
  }
  if (options.video_frames_per_second) {
    video_.emplace(folder_.staging() / kVideoFile, painter_.size_px(),
                   *options.video_frames_per_second);
  }
}

void Result::add(const FrameRecord& frame, const cv::Mat3b& image) {
  if (writer_) writer_->write(frame);
  if (video_ || show_) {
    const cv::Mat3b sheet = painter_.paint(frame, image);
    if (video_) video_->write(sheet);
    if (show_ && !show_(sheet)) show_ = {};
  }
  if (events_ && !kept_ && !image.empty()) own_pictures_.add(image);
}

Metrics Result::finish(const Recording& run) {
  if (writer_) writer_->close();
  if (video_) video_->close();
  Metrics metrics = score(run);
  write_metrics(folder_.staging() / kMetricsFile, metrics);
  if (keep_ != Keep::figures) write_frames(folder_.staging() / kFramesFile, run);
  if (run.warnings) write_warnings(folder_.staging() / kWarningsFile, warnings_of(run));
  if (events_) {
    const FramePictures& pictures = kept_ ? *kept_ : own_pictures_;
    std::vector<Event> events = find_events(run, kAllEvents);
    std::ranges::move(find_square_events(run, kAllEvents), std::back_inserter(events));
    const EventSums sums = sums_of(events);
    keep_worst(events, kMostEvents);
    if (pictures.size() > 0) {
      paint_events(run, pictures, events);
      if (keep_ == Keep::all) pictures.write(folder_.staging() / kPicturesFile);
    }
    write_events(folder_.staging() / kEventsFile, events, sums);
  }
  if (add_page_) add_page_(folder_.staging(), metrics);
  return metrics;
}

void Result::share_truth(const Result& other) {
  if (!writer_ || !other.writer_) return;
  const std::filesystem::path theirs = stored(other.folder_.staging(), kTruthFile);
  link_or_copy(theirs, folder_.staging() / theirs.filename());
}

}  // namespace lcs::bench
