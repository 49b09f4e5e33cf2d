#include "tools/replay/picture_stream.h"

#include <fmt/format.h>

#include "tools/output/video_reader.h"

namespace lcs::replay {

PictureStream::PictureStream(const Recorded& recorded)
    : video_(recorded.video), files_(recorded.format) {
  if (!video_.empty()) capture_ = bench::open_video(video_);
}

const std::vector<std::string>& PictureStream::skipped() const {
  return video_.empty() ? files_.skipped() : skipped_;
}

std::optional<cv::Mat3b> PictureStream::read(const RecordedFrame& frame) {
  return video_.empty() ? files_.read(frame.picture) : read_video(frame);
}

std::optional<cv::Mat3b> PictureStream::read_video(const RecordedFrame& frame) {
  const auto skip = [&](const std::string& why) {
    skipped_.push_back(fmt::format("picture {} of {} {}", frame.number, video_.string(), why));
    return std::nullopt;
  };
  if (has_ended_) return std::nullopt;
  for (; next_ <= frame.number && !has_ended_; ++next_) has_ended_ = !capture_->grab();
  if (has_ended_) return skip("cannot be read, and none after it");
  cv::Mat picture;
  if (!capture_->retrieve(picture) || picture.type() != CV_8UC3) return skip("cannot be read");
  if (size_.empty()) size_ = picture.size();
  if (picture.size() != size_) return skip("is of another size than those before it");
  return cv::Mat3b(picture.clone());
}

}  // namespace lcs::replay
