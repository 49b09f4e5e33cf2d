/// \file
/// Pictures for tests, by the codecs that the program loads.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
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

}  // namespace lcs::test
