/// \file
/// An MP4 file, frame by frame.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "tools/files/output_file.h"

namespace lcs::bench {

inline constexpr const char* kVideoFile = "video.mp4";

class Video {
 public:
  /// H.264 where this machine's OpenCV can encode it, MPEG-4 part 2 where not.
  /// \param size_px even in both directions.
  /// \throws OutputError where neither can be written.
  Video(const std::filesystem::path& path, cv::Size size_px, double frames_per_second);

  /// \param frame of the size given.
  void write(const cv::Mat3b& frame);

  /// \throws OutputError when the file is not complete, as when the disk is full: OpenCV itself
  ///   never says so.
  void close();

 private:
  std::filesystem::path path_;
  cv::VideoWriter writer_;
  int frames_ = 0;
};

}  // namespace lcs::bench
