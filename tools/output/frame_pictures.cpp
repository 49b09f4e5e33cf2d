#include "tools/output/frame_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sim/pictures/picture_file.h"
#include "tools/files/output_file.h"
#include "tools/input/input_file.h"

namespace lcs::bench {
namespace {

/// A JPEG's first and last marker. OpenCV's JPEG data contain neither in between.
constexpr std::string_view kJpegStart = "\xff\xd8", kJpegEnd = "\xff\xd9";

constexpr const char* kRecordAgain = "run the scenario with --events again";

constexpr int kKeptWidth_px = 640;
constexpr int kKeptQuality = 88;

double kept_scale(int image_width_px) {
  return std::min(1.0, static_cast<double>(kKeptWidth_px) / image_width_px);
}

}  // namespace

void FramePictures::add(const cv::Mat3b& image) {
  scale_ = kept_scale(image.cols);
  cv::Mat3b kept = image;
  if (scale_ < 1) cv::resize(image, kept, {}, scale_, scale_, cv::INTER_AREA);
  jpegs_.push_back(sim::encode_jpeg(kept, kKeptQuality));
}

FramePictures FramePictures::read(const std::filesystem::path& file, cv::Size image_px) {
  // At 40 kB a picture, enough for hundreds of thousands of frames.
  constexpr input::FileKind kMotionJpeg{16 * input::kGibibyte, kRecordAgain};
  const std::string bytes = input::read_file(file, kMotionJpeg);
  FramePictures pictures;
  pictures.scale_ = kept_scale(image_px.width);
  const cv::Size2l expected(cvRound(image_px.width * pictures.scale_),
                            cvRound(image_px.height * pictures.scale_));
  for (std::size_t start = 0; start < bytes.size();) {
    const std::size_t end = bytes.find(kJpegEnd, start);
    if (bytes.compare(start, kJpegStart.size(), kJpegStart) != 0 || end == std::string::npos) {
      throw input::Error({file.string(), 0}, "not a JPEG picture at byte " + std::to_string(start) +
                                                 "; " + kRecordAgain);
    }
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(start);
    const std::size_t length = end + kJpegEnd.size() - start;
    const auto size = sim::picture_size({bytes.data() + start, length}).value_or(cv::Size2l());
    if (size != expected) {
      throw input::Error(
          {file.string(), 0},
          fmt::format(
              "picture {} has {} x {} pixels, and one of a camera of {} x {} has {} x {}; {}",
              pictures.size(), size.width, size.height, image_px.width, image_px.height,
              expected.width, expected.height, kRecordAgain));
    }
    pictures.jpegs_.emplace_back(first, first + static_cast<std::ptrdiff_t>(length));
    start += length;
  }
  return pictures;
}

void FramePictures::write(const std::filesystem::path& file) const {
  OutputFile output(file);
  for (const auto& bytes : jpegs_) {
    output.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  output.close();
}

cv::Mat3b FramePictures::at(std::size_t position, double& scale) const {
  scale = scale_;
  const std::vector<unsigned char>& bytes = jpegs_.at(position);
  try {
    return sim::decode_picture({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                               cv::IMREAD_COLOR);
  } catch (const sim::PictureError&) {
    throw std::runtime_error("picture " + std::to_string(position) + " of " + kPicturesFile +
                             " is broken; " + kRecordAgain);
  }
}

}  // namespace lcs::bench
