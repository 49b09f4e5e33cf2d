#include "tools/replay/picture_stream.h"

#include <fmt/format.h>

namespace lcs::replay {

PictureStream::PictureStream(const Recorded& recorded)
    : video_(recorded.video), files_(recorded.demosaic) {
  if (video_) capture_.open(recorded.frames.front().picture.string(), cv::CAP_FFMPEG);
}

const std::vector<std::string>& PictureStream::skipped() const {
  return video_ ? skipped_ : files_.skipped();
}

std::optional<cv::Mat3b> PictureStream::read(const RecordedFrame& frame) {
  return video_ ? read_video(frame) : files_.read(frame.picture);
}

std::optional<cv::Mat3b> PictureStream::read_video(const RecordedFrame& frame) {
  const auto skip = [&](const std::string& why) {
    skipped_.push_back(
        fmt::format("picture {} of {} {}", frame.number, frame.picture.string(), why));
    return std::nullopt;
  };
  cv::Mat picture;
  bool is_read = true;
  for (; next_ < frame.number && is_read; ++next_) is_read = capture_.grab();
  ++next_;
  if (!is_read || !capture_.read(picture) || picture.type() != CV_8UC3) {
    return skip("cannot be read");
  }
  if (size_.empty()) size_ = picture.size();
  if (picture.size() != size_) return skip("is of another size than those before it");
  return cv::Mat3b(picture.clone());
}

}  // namespace lcs::replay
