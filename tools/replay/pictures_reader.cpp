// Pictures of files and videos, and layouts that the user describes: a folder, a video, a sequence
// of MOTChallenge.

#include <bit>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "scenarios/input/input_file.h"
#include "sim/pictures/media.h"
#include "sim/pictures/picture_file.h"
#include "tools/files/csv.h"
#include "tools/output/video.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

constexpr input::FileKind kVideo{
    64 * input::kGibibyte,
    "give a whole MP4, MOV, AVI, MKV, WebM, MPEG, FLV, ASF or OGG, or its pictures in a folder"};

constexpr const char* kSequenceInfo = "seqinfo.ini";

/// Reads "key=value" lines of a section [Sequence].
std::map<std::string, std::string> read_info(const fs::path& file) {
  constexpr input::FileKind kInfo{input::kMebibyte, "give the file as MOTChallenge has it"};
  input::InputFile input(file, kInfo);
  std::map<std::string, std::string> info;
  for (std::string line; input.next_line(line);) {
    const std::size_t equals = line.find('=');
    if (equals == line.npos) continue;
    const std::string_view text = line;
    info[std::string(files::trimmed(text.substr(0, equals)))] =
        files::trimmed(text.substr(equals + 1));
  }
  return info;
}

/// The pictures in the order of their numbers, or by name if that order is not certain.
void take_unordered(const fs::path& folder, Recorded& recorded) {
  try {
    take_pictures(folder, "", recorded);
  } catch (const input::Error&) {
    const std::vector<fs::path> files = pictures_in(folder);
    for (std::size_t i = 0; i < files.size(); ++i) recorded.frames.push_back({0, files[i], i});
    number_frames(recorded, false);
  }
  recorded.timed = false;
}

/// The first of the usual lists of times that is in a folder; "" if none is.
fs::path list_in(const fs::path& folder) {
  for (const char* name : {"times.txt", "images.txt", "timestamps.txt", "times.csv", "color.txt"}) {
    if (fs::exists(folder / name)) return folder / name;
  }
  return "";
}

/// The folder of the pictures beside such a list; "" if there is none.
fs::path pictures_of_list(const fs::path& folder) {
  for (const char* name : {"images", "img", "undistorted_images/cam0", "distorted_images/cam0",
                           "cam0", "frames", "rgb", "color", "pictures", "."}) {
    if (fs::is_directory(folder / name) && is_pictures(folder / name)) return folder / name;
  }
  return "";
}

/// Gives each picture of a video its own time, from 0 on.
void time_by_video(const std::vector<std::int64_t>& times_ns, Recorded& recorded) {
  for (RecordedFrame& frame : recorded.frames) {
    frame.t_ns = times_ns[frame.number] - times_ns.front();
  }
  sort_by_time(recorded.frames, "pictures", recorded.video.string(), recorded.tally);
  recorded.timed = true;
  recorded.has_own_clock = true;
}

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

bool is_pictures(const fs::path& folder) {
  try {
    return !pictures_in(folder).empty();
  } catch (const std::runtime_error&) {
    return false;
  }
}

Recorded read_pictures(const RecordingSource& asked, bool) {
  Recorded recorded;
  if (asked.times) {  // perhaps it names the pictures, whose order is then of no matter
    take_unordered(asked.path, recorded);
  } else {
    // With fps the unit belongs to a table beside the pictures.
    take_pictures(asked.path, asked.fps ? "" : asked.time_unit, recorded);
  }
  return recorded;
}

bool is_listed(const fs::path& folder) {
  return !list_in(folder).empty() && !pictures_of_list(folder).empty();
}

Recorded read_listed(const RecordingSource& asked, bool) {
  const fs::path list = list_in(asked.path), pictures = pictures_of_list(asked.path);
  if (list.empty() || pictures.empty()) {
    refuse(asked.source,
           "{} has no list of times or no pictures; give times.txt or images.txt beside a folder "
           "of pictures",
           asked.path.string());
  }
  Recorded recorded;
  take_unordered(pictures, recorded);
  if (!asked.times) time_by_table(list, asked.time_unit, recorded);
  recorded.took.insert("time_unit");
  return recorded;
}

bool is_mot(const fs::path& folder) {
  return fs::exists(folder / kSequenceInfo);
}

Recorded read_mot(const RecordingSource& asked, bool) {
  const std::map<std::string, std::string> info = read_info(asked.path / kSequenceInfo);
  const auto text = [&](const char* key, const char* otherwise) {
    const auto found = info.find(key);
    return found == info.end() ? std::string(otherwise) : found->second;
  };
  Recorded recorded;
  take_pictures(asked.path / text("imDir", "img1"), "", recorded);
  recorded.numbers.first = 1;
  recorded.timed = false;
  constexpr double kFastest_hz = 10000;
  const auto rate_hz = files::number_in<double>(text("frameRate", ""));
  if (rate_hz && *rate_hz > 0 && *rate_hz <= kFastest_hz) recorded.fps = rate_hz;
  const auto listed = files::number_in<std::size_t>(text("seqLength", ""));
  if (listed && *listed != recorded.frames.size()) {
    recorded.tally.add("lists of pictures have another length than there are pictures",
                       fmt::format("{}, {} and not {}", (asked.path / kSequenceInfo).string(),
                                   *listed, recorded.frames.size()));
  }
  return recorded;
}

bool is_video(const fs::path& file) {
  return fs::is_regular_file(file);
}

Recorded read_video(const RecordingSource& asked, bool) {
  const input::InputFile no_pipe(asked.path, kVideo, asked.source);
  const auto video = output::open_video(asked.path);
  const auto refuse_it = [&](const std::string& what) {
    refuse(asked.source, "{} {}; {}", asked.path.string(), what, kVideo.remedy);
  };
  if (!video->isOpened()) refuse_it("is no video that can be read");
  const double width = video->get(cv::CAP_PROP_FRAME_WIDTH);
  const double height = video->get(cv::CAP_PROP_FRAME_HEIGHT);
  if (width * height > static_cast<double>(sim::kMostPixels)) {
    refuse_it(fmt::format("has pictures of {:.0f} x {:.0f} pixels, and can have {} million in all",
                          width, height, sim::kMostPixels / 1'000'000));
  }
  Recorded recorded;
  recorded.video = asked.path;
  recorded.timed = false;
  const sim::VideoTimes times = sim::media().video_times(fs::absolute(asked.path).string());
  if (times.t_ns.empty()) refuse_it("has no picture that can be read");
  for (std::size_t i = 0; i < times.t_ns.size(); ++i) recorded.frames.push_back({0, {}, i});
  recorded.numbers.pictures = recorded.frames.size();
  if (times.counted > std::ssize(times.t_ns)) {
    recorded.tally.tell("the video ends after {} of the {} pictures of its header",
                        times.t_ns.size(), times.counted);
  }
  const double span_s = seconds(times.t_ns.back() - times.t_ns.front());
  const double own_hz = static_cast<double>(times.t_ns.size() - 1) / span_s;
  const auto differs = [&](double hz) {
    constexpr double kSame = 0.05;
    return span_s > 0 && std::abs(hz / own_hz - 1) > kSame;
  };
  if (asked.times || !times.are_stated) return recorded;
  if (asked.fps) {
    if (differs(*asked.fps)) {
      recorded.tally.tell(
          "fps gives the pictures {:g} Hz, and by the video's own times they have {:.4g} Hz",
          *asked.fps, own_hz);
    }
    return recorded;
  }
  time_by_video(times.t_ns, recorded);
  if (const double nominal_hz = video->get(cv::CAP_PROP_FPS); differs(nominal_hz)) {
    recorded.tally.tell(
        "the video states {:.4g} Hz, and its pictures have {:.4g} Hz; each has its own time",
        nominal_hz, own_hz);
  }
  return recorded;
}

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
