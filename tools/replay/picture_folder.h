/// \file
/// Pictures from files, and a folder of them as a sequence of frames.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lcs::replay {

/// Pictures that are all of one size.
class PictureReader {
 public:
  /// \param demosaic OpenCV's colour conversion for raw pictures of one channel, if they are.
  explicit PictureReader(std::optional<int> demosaic = {}) : demosaic_(demosaic) {}

  /// The picture, BGR, or nothing for one that is not there, cannot be read, or is of another size
  /// than those before it; `skipped` then says why.
  std::optional<cv::Mat3b> read(const std::filesystem::path& file);

  /// One line for each picture that was skipped.
  const std::vector<std::string>& skipped() const { return skipped_; }

 private:
  std::optional<int> demosaic_;
  std::vector<std::string> skipped_;
  cv::Size size_;
};

/// The pictures of a folder (PNG, JPEG, BMP, TIFF, PGM, PPM), by the last number in their names,
/// then by name: frame2.png comes before frame10.png.
class PictureFolder {
 public:
  /// \throws std::runtime_error for a folder that cannot be read, or holds no picture.
  explicit PictureFolder(const std::filesystem::path& folder);

  std::size_t size() const { return files_.size(); }
  const std::filesystem::path& file(std::size_t index) const { return files_.at(index); }

 private:
  std::vector<std::filesystem::path> files_;
};

}  // namespace lcs::replay
