/// \file
/// The pictures of a recording's frames, from files or a video.
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/replay/picture_reader.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

class PictureStream {
 public:
  explicit PictureStream(const Recorded& recorded);

  /// \param frame later in the recording than those before it.
  /// \return the BGR picture; absent if unusable. `skipped` then gives the reason.
  std::optional<cv::Mat3b> read(const RecordedFrame& frame);

  /// One line for each skipped picture.
  const std::vector<std::string>& skipped() const;

 private:
  std::optional<cv::Mat3b> read_video(const RecordedFrame& frame);

  std::filesystem::path video_;  ///< empty: the pictures are files
  PictureReader files_;
  std::unique_ptr<cv::VideoCapture> capture_;
  std::size_t next_ = 0;  ///< index of the next picture in the video
  bool has_ended_ = false;
  cv::Size size_;
  std::vector<std::string> skipped_;  ///< of the video
};

}  // namespace lcs::replay
