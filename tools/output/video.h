/// \file
/// Writes an MP4 file frame by frame, and opens video files safely.
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "sim/pictures/media.h"
#include "tools/files/output_file.h"

namespace lcs::output {

inline constexpr const char* kVideoFile = "video.mp4";

class Video {
 public:
  /// \param size_px even width and height.
  /// \throws OutputError if no video can be written there.
  Video(const std::filesystem::path& path, cv::Size size_px, double frames_per_second);

  /// \param frame of size `size_px`.
  void write(const cv::Mat3b& frame) { is_whole_ &= file_->write(frame); }

  /// \throws OutputError if the file is incomplete, for example on a full disk.
  void close();

 private:
  std::filesystem::path path_;
  std::unique_ptr<sim::VideoFile> file_;
  bool is_whole_ = true;
};

/// All videos are opened by this function. By default FFmpeg guesses formats: it decodes text as
/// pictures, and follows playlists to other files. This reads only MP4, MOV, AVI, MKV, WebM, MPEG,
/// FLV, ASF and OGG. \return not opened for any other format.
std::unique_ptr<cv::VideoCapture> open_video(const std::filesystem::path& file);

}  // namespace lcs::output
