/// \file
/// The camera's images of a run, compressed.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

namespace lcs::bench {

inline constexpr const char* kPicturesFile = "pictures.mjpeg";

/// The images of a run, kept compressed until its events are known. Wider images are scaled down to
/// 640 px: about 40 kB a frame.
class FramePictures {
 public:
  /// Reads a file of `write`. \param image_px size of the run's images.
  /// \throws input::Error naming the file and its fault, also for pictures whose size differs
  ///   from that made by `add`.
  static FramePictures read(const std::filesystem::path& file, cv::Size image_px);
  /// Writes Motion JPEG: concatenated pictures. \throws OutputError
  void write(const std::filesystem::path& file) const;

  /// \param image of the next frame of the recording, BGR.
  void add(const cv::Mat3b& image);

  /// \param scale set to picture pixels per image pixel.
  /// \throws std::runtime_error for a damaged picture.
  cv::Mat3b at(std::size_t position, double& scale) const;
  std::size_t size() const { return jpegs_.size(); }

 private:
  std::vector<std::vector<unsigned char>> jpegs_;
  double scale_ = 1;
};

}  // namespace lcs::bench
