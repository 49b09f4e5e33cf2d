#include "tools/replay/recorded.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "sim/pictures/picture_file.h"
#include "tools/output/video.h"

namespace lcs::replay {
namespace {

/// \return a picture of 8 or 16 bits. \throws input::Error
cv::Mat decode(const fs::path& file, bool is_raw) {
  const int flags = is_raw ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR;
  cv::Mat picture = sim::read_picture(file, {file.string(), 0}, flags | cv::IMREAD_ANYDEPTH);
  if (picture.depth() != CV_8U && picture.depth() != CV_16U) {
    picture = sim::read_picture(file, {file.string(), 0}, flags);
  }
  return picture;
}

/// The upper 8 of the bits in use.
cv::Mat to_8_bits(const cv::Mat& picture, int bits) {
  if (picture.depth() == CV_8U) return picture;
  const cv::Mat1w values = picture.reshape(1);
  cv::Mat1b upper(values.size());
  std::ranges::transform(values, upper.begin(), [bits](std::uint16_t value) {
    return static_cast<unsigned char>(std::min(value >> (bits - 8), 255));
  });
  return upper.reshape(picture.channels());
}

/// The value that nearly no pixel exceeds: some are hot.
unsigned brightest_of(const cv::Mat& picture) {
  constexpr double kHot = 1e-4;  // share of the values
  std::vector<std::uint16_t> values(picture.begin<std::uint16_t>(), picture.end<std::uint16_t>());
  const auto last = static_cast<double>(values.size() - 1);
  const auto bright = values.begin() + static_cast<std::ptrdiff_t>((1 - kHot) * last);
  std::ranges::nth_element(values, bright);
  return *bright;
}

}  // namespace

int demosaic_of(const std::string& pattern) {
  // OpenCV names a pattern by its second row.
  static const std::map<std::string, int> kPatterns{{"rggb", cv::COLOR_BayerBG2BGR},
                                                    {"bggr", cv::COLOR_BayerRG2BGR},
                                                    {"grbg", cv::COLOR_BayerGB2BGR},
                                                    {"gbrg", cv::COLOR_BayerGR2BGR}};
  return kPatterns.at(pattern);
}

PictureReader::PictureReader(const PictureFormat& format, const fs::path& video)
    : format_(format), video_(video) {
  if (!video_.empty()) capture_ = output::open_video(video_);
}

std::optional<cv::Mat3b> PictureReader::read(const RecordedFrame& frame) {
  return video_.empty() ? read_file(frame.picture) : read_video(frame);
}

std::optional<cv::Mat3b> PictureReader::read_video(const RecordedFrame& frame) {
  const auto skip = [&](const std::string& why) {
    skipped_.push_back(fmt::format("picture {} of {} {}", frame.number, video_.string(), why));
    return std::nullopt;
  };
  if (has_ended_) return std::nullopt;
  for (; next_ <= frame.number && !has_ended_; ++next_) has_ended_ = !capture_->grab();
  if (has_ended_) return skip("cannot be read, and none after it");
  cv::Mat picture;
  if (!capture_->retrieve(picture) || picture.type() != CV_8UC3) return skip("cannot be read");
  if (format_.size_px.empty()) format_.size_px = picture.size();
  if (picture.size() != format_.size_px) return skip("is of another size than those before it");
  return cv::Mat3b(picture.clone());
}

std::optional<cv::Mat3b> PictureReader::read_file(const fs::path& file) {
  const auto skip = [&](std::string why) {
    skipped_.push_back(std::move(why));
    return std::nullopt;
  };
  std::error_code error;
  if (!fs::exists(file, error)) return skip(fmt::format("{} is missing", file.string()));
  cv::Mat picture;
  try {
    picture = decode(file, format_.demosaic.has_value());
  } catch (const input::Error& refused) {
    return skip(refused.what());
  }
  if (format_.size_px.empty()) format_.size_px = picture.size();
  if (picture.size() != format_.size_px) {
    return skip(fmt::format("{} is {}x{}, not {}x{} as the others", file.string(), picture.cols,
                            picture.rows, format_.size_px.width, format_.size_px.height));
  }
  picture = to_8_bits(picture, format_.bits);
  if (!format_.demosaic) return cv::Mat3b(picture);
  cv::Mat3b image;
  cv::cvtColor(picture, image, *format_.demosaic);
  return image;
}

PictureFormat common_format(const std::vector<fs::path>& files) {
  constexpr std::size_t kSample = 15;
  std::map<std::pair<int, int>, int> sizes;
  int most = 0;
  PictureFormat format{.size_px = {}, .bits = 8, .is_deep = false, .demosaic = {}};
  const std::size_t step = std::max<std::size_t>(1, files.size() / kSample);
  for (std::size_t i = 0; i < files.size(); i += step) {
    if (std::error_code error; !fs::exists(files[i], error)) continue;
    try {
      const cv::Mat picture = decode(files[i], false);
      const int count = ++sizes[{picture.cols, picture.rows}];
      if (count > most) {
        most = count;
        format.size_px = picture.size();
      }
      if (picture.depth() != CV_16U) continue;
      format.is_deep = true;
      const int used = static_cast<int>(std::bit_width(brightest_of(picture.reshape(1))));
      format.bits = std::max(format.bits, used + used % 2);
    } catch (const input::Error&) {
      continue;  // told when its turn comes
    }
  }
  return format;
}

}  // namespace lcs::replay
