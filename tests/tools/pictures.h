/// \file
/// Pictures and videos for tests, by the codecs that the program loads.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "sim/pictures/media.h"
#include "tests/tools/files.h"

namespace lcs::test {

/// Writes a picture in the format of the file's extension.
inline void write_picture(const std::filesystem::path& file, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  ASSERT_TRUE(sim::media().imencode(file.extension(), picture, bytes, {})) << file;
  write(file, {bytes.begin(), bytes.end()});
}

/// A video to write to. \param codec four characters.
inline std::unique_ptr<cv::VideoWriter> new_video(const std::filesystem::path& file,
                                                  const char* codec, double frames_per_second,
                                                  const cv::Size& size_px) {
  auto video = sim::media().write_video(file.string(), codec, frames_per_second, size_px);
  EXPECT_TRUE(video->isOpened()) << file;
  return video;
}

}  // namespace lcs::test
