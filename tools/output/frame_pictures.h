/// \file
/// The camera's images of a run, compressed, in a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "scenarios/input/input_file.h"
#include "tools/files/output_file.h"

namespace lcs::output {

inline constexpr const char* kPicturesFile = "pictures.mjpeg";

/// Writes Motion JPEG: concatenated pictures. Wider images are scaled down to 640 px: about 40 kB a
/// frame.
class PicturesWriter {
 public:
  /// \throws OutputError
  explicit PicturesWriter(const std::filesystem::path& file) : file_(file) {}
  /// \param image of the next frame, BGR. \throws OutputError
  void write(const cv::Mat3b& image);
  /// \throws OutputError
  void close() { file_.close(); }

 private:
  files::OutputFile file_;
};

/// The images of a run in a file of `PicturesWriter`. Each is read when it is asked for.
class FramePictures {
 public:
  /// \param image_px size of the run's images.
  /// \throws input::Error naming the file and its fault, also for pictures whose size differs
  ///   from that made by `PicturesWriter`.
  FramePictures(const std::filesystem::path& file, cv::Size image_px);

  /// \param scale set to picture pixels per image pixel.
  /// \throws input::Error; std::runtime_error for a damaged picture.
  cv::Mat3b at(std::size_t position, double& scale) const;
  /// The same, resized to the run's images.
  cv::Mat3b image(std::size_t position) const;
  std::size_t size() const { return starts_.size() - 1; }

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  input::InputFile file_;
  std::vector<std::uint64_t> starts_{0};  ///< of each picture in the file, then the file's end
  cv::Size image_px_;
  double scale_;
};

}  // namespace lcs::output
