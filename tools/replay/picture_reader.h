/// \file
/// Reads pictures from files, and a folder of pictures as a sequence of frames.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lcs::replay {

/// Reads pictures of one common size.
class PictureReader {
 public:
  /// \param demosaic OpenCV's colour conversion if the pictures are raw, with one channel.
  explicit PictureReader(std::optional<int> demosaic = {}) : demosaic_(demosaic) {}

  /// \return the BGR picture; absent if the file is missing, unreadable or of another size than
  /// those before it. `skipped` then gives the reason.
  std::optional<cv::Mat3b> read(const std::filesystem::path& file);

  /// One line for each skipped picture.
  const std::vector<std::string>& skipped() const { return skipped_; }

 private:
  std::optional<int> demosaic_;
  std::vector<std::string> skipped_;
  cv::Size size_;
};

/// The pictures of a folder (PNG, JPEG, BMP, TIFF, PGM, PPM), sorted by the last number in their
/// names, then by name: frame2.png precedes frame10.png.
class PictureFolder {
 public:
  /// \throws std::runtime_error for a folder that cannot be read or has no picture.
  explicit PictureFolder(const std::filesystem::path& folder);

  std::size_t size() const { return files_.size(); }
  const std::filesystem::path& file(std::size_t index) const { return files_.at(index); }

 private:
  std::vector<std::filesystem::path> files_;
};

}  // namespace lcs::replay
