/// \file
/// Reads pictures of one size from files.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lcs::replay {

/// The properties that the pictures of a recording have in common.
struct PictureFormat {
  cv::Size size_px;             ///< empty: that of the first picture
  int bits = 16;                ///< in use where a picture has 16
  std::optional<int> demosaic;  ///< OpenCV's colour conversion of raw pictures, with one channel
};

/// OpenCV's conversion for a pattern, from the top left pixel on: rggb, bggr, grbg or gbrg.
int demosaic_of(const std::string& pattern);

class PictureReader {
 public:
  explicit PictureReader(const PictureFormat& format) : format_(format) {}

  /// \return the BGR picture, of 8 bits; absent if the file is missing, unreadable or of another
  /// size. `skipped` then gives the reason.
  std::optional<cv::Mat3b> read(const std::filesystem::path& file);

  /// One line for each skipped picture.
  const std::vector<std::string>& skipped() const { return skipped_; }

 private:
  PictureFormat format_;
  std::vector<std::string> skipped_;
};

/// The most frequent size of some of the files, spread over all, and the least of 8, 10, 12, 14 and
/// 16 bits that their values keep to; the size is empty if none can be read.
PictureFormat common_format(const std::vector<std::filesystem::path>& files);

}  // namespace lcs::replay
