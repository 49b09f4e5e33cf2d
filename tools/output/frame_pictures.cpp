#include "tools/output/frame_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sim/pictures/picture_file.h"

namespace lcs::output {
namespace {

/// A JPEG's first and last marker. The data of `sim::encode_jpeg` contain neither in between.
constexpr std::string_view kJpegStart = "\xff\xd8", kJpegEnd = "\xff\xd9";

constexpr const char* kRecordAgain = "run the scenario with --events again";

constexpr int kKeptWidth_px = 640;
constexpr int kKeptQuality = 88;

double kept_scale(int image_width_px) {
  return std::min(1.0, static_cast<double>(kKeptWidth_px) / image_width_px);
}

}  // namespace

void PicturesWriter::write(const cv::Mat3b& image) {
  const double scale = kept_scale(image.cols);
  cv::Mat3b kept = image;
  if (scale < 1) cv::resize(image, kept, {}, scale, scale, cv::INTER_AREA);
  file_.write(sim::encode_jpeg(kept, kKeptQuality));
}

// At 40 kB a picture, enough for hundreds of thousands of frames.
constexpr input::FileKind kMotionJpeg{16 * input::kGibibyte, kRecordAgain};

FramePictures::FramePictures(const std::filesystem::path& file, cv::Size image_px)
    : path_(file),
      file_(file, kMotionJpeg),
      image_px_(image_px),
      scale_(kept_scale(image_px.width)) {
  constexpr std::size_t kBlock = 1 << 16;
  const cv::Size2l expected(cvRound(image_px.width * scale_), cvRound(image_px.height * scale_));
  const auto fail = [&](const std::string& what) {
    throw input::Error({file.string(), 0}, "{}; {}", what, kRecordAgain);
  };
  std::string bytes;  // from the last start on
  while (true) {
    std::size_t end = bytes.find(kJpegEnd);
    while (end == std::string::npos) {
      const std::string more = file_.bytes_at(starts_.back() + bytes.size(), kBlock);
      if (more.empty()) break;
      const std::size_t seen = bytes.empty() ? 0 : bytes.size() - 1;
      bytes += more;
      end = bytes.find(kJpegEnd, seen);
    }
    if (bytes.empty()) return;
    if (!bytes.starts_with(kJpegStart) || end == std::string::npos) {
      fail(fmt::format("not a JPEG picture at byte {}", starts_.back()));
    }
    const std::size_t length = end + kJpegEnd.size();
    const auto size = sim::picture_size({bytes.data(), length}).value_or(cv::Size2l());
    if (size != expected) {
      fail(fmt::format("picture {} has {} x {} pixels, and one of a camera of {} x {} has {} x {}",
                       this->size(), size.width, size.height, image_px.width, image_px.height,
                       expected.width, expected.height));
    }
    starts_.push_back(starts_.back() + length);
    bytes.erase(0, length);
  }
}

cv::Mat3b FramePictures::at(std::size_t position, double& scale) const {
  scale = scale_;
  const std::uint64_t start = starts_.at(position);
  const std::string bytes = file_.bytes_at(start, starts_.at(position + 1) - start);
  try {
    return sim::decode_jpeg(bytes);
  } catch (const sim::PictureError&) {
    throw std::runtime_error("picture " + std::to_string(position) + " of " + kPicturesFile +
                             " is broken; " + kRecordAgain);
  }
}

cv::Mat3b FramePictures::image(std::size_t position) const {
  double scale = 1;
  cv::Mat3b picture = at(position, scale);
  if (picture.size() != image_px_) cv::resize(picture, picture, image_px_, 0, 0, cv::INTER_LINEAR);
  return picture;
}

}  // namespace lcs::output
