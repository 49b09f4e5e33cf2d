/// \file
/// What the camera saw in each frame, kept small.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

namespace lcs::bench {

/// \param quality of JPEG, to 100. \throws std::runtime_error
std::vector<unsigned char> jpeg(const cv::Mat3b& image, int quality);

inline constexpr const char* kPicturesFile = "pictures.mjpeg";

/// The images of a run, kept compressed until its events are known at its end. Images wider than
/// 640 px are kept at that width: some 40 kB a frame.
class FramePictures {
 public:
  /// Reads back what `write` wrote. \param image_px the size of the run's images.
  /// \throws scenario::Error naming the file and what is wrong with it, also for pictures of
  /// another
  ///   size than `add` makes of such images.
  static FramePictures read(const std::filesystem::path& file, cv::Size image_px);
  /// As Motion JPEG: one picture after the other, and nothing else. \throws OutputError
  void write(const std::filesystem::path& file) const;

  /// \param image of the next frame of the recording, BGR.
  void add(const cv::Mat3b& image);

  /// \param scale set to the picture's pixels for each pixel of the image.
  /// \throws std::runtime_error for a picture that is damaged.
  cv::Mat3b at(std::size_t position, double& scale) const;
  std::size_t size() const { return jpegs_.size(); }

 private:
  std::vector<std::vector<unsigned char>> jpegs_;
  double scale_ = 1;
};

}  // namespace lcs::bench
