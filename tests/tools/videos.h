/// \file
/// Videos for tests, of the kinds that cameras write.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <opencv2/videoio.hpp>
#include <string>

namespace lcs::test {

/// A video to write to. \param codec four characters.
inline std::unique_ptr<cv::VideoWriter> new_video(const std::filesystem::path& file,
                                                  const std::string& codec,
                                                  double frames_per_second,
                                                  const cv::Size& size_px) {
  const int code = cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]);
  auto video = std::make_unique<cv::VideoWriter>(file.string(), cv::CAP_FFMPEG, code,
                                                 frames_per_second, size_px);
  EXPECT_TRUE(video->isOpened()) << file;
  return video;
}

}  // namespace lcs::test
