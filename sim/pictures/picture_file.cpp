#include "sim/pictures/picture_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <string>

#include "scenarios/input/input_file.h"
#include "sim/pictures/media.h"

namespace lcs::sim {
namespace {

using Size = std::optional<cv::Size2l>;
using Integer = std::int64_t;

/// 8192 x 8192 pixels of three bytes are 192 MiB uncompressed.
constexpr input::FileKind kPictureFile{256 * input::kMebibyte, "give a PNG or JPEG picture"};

constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n", kJpeg = "\xff\xd8\xff",
                           kJpegEnd = "\xff\xd9";

/// Reads an unsigned number; bytes beyond the end count as 0.
Integer number_at(std::string_view bytes, std::size_t at, int length, bool big_endian) {
  Integer number = 0;
  for (int i = 0; i < length; ++i) {
    const std::size_t place = at + static_cast<std::size_t>(big_endian ? i : length - 1 - i);
    number = number << 8 | (place < bytes.size() ? static_cast<unsigned char>(bytes[place]) : 0);
  }
  return number;
}

/// Offset of a JPEG's frame header; npos if no frame header precedes the first scan.
std::size_t jpeg_frame(std::string_view bytes) {
  constexpr int kStuffed = 0x00, kTemporary = 0x01, kFirstFrame = 0xc0, kLastFrame = 0xcf,
                kHuffmanTables = 0xc4, kExtension = 0xc8, kConditioning = 0xcc, kRestart = 0xd0,
                kEnd = 0xd9, kScan = 0xda, kFill = 0xff;
  for (std::size_t at = 2; (at = bytes.find('\xff', at)) < bytes.size();) {
    const int marker = static_cast<int>(number_at(bytes, ++at, 1, true));
    if (marker == kFill) continue;  // the marker follows
    const bool is_frame = marker >= kFirstFrame && marker <= kLastFrame &&
                          marker != kHuffmanTables && marker != kExtension &&
                          marker != kConditioning;
    if (is_frame) return at;
    if (marker == kEnd || marker == kScan) break;
    const bool is_alone =
        marker == kStuffed || marker == kTemporary || (marker >= kRestart && marker < kEnd);
    at += is_alone ? 1 : 1 + static_cast<std::size_t>(number_at(bytes, at + 1, 2, true));
  }
  return std::string_view::npos;
}

Size jpeg_size(std::string_view bytes) {
  const std::size_t frame = jpeg_frame(bytes);
  if (frame == std::string_view::npos) return std::nullopt;
  return cv::Size2l(number_at(bytes, frame + 6, 2, true), number_at(bytes, frame + 4, 2, true));
}

Size bmp_size(std::string_view bytes) {
  constexpr Integer kOfOs2 = 12, kOfWindows = 36;  // bytes of the header
  const Integer header = number_at(bytes, 14, 4, false);
  if (header == kOfOs2) {
    return cv::Size2l(number_at(bytes, 18, 2, false), number_at(bytes, 20, 2, false));
  }
  if (header < kOfWindows) return std::nullopt;
  const auto side = [&](std::size_t at) {  // negative for top-down rows
    return std::abs(
        static_cast<Integer>(static_cast<std::int32_t>(number_at(bytes, at, 4, false))));
  };
  return cv::Size2l(side(18), side(22));
}

/// Image size of a PNM file: two numbers as text, with comments between them.
Size pnm_size(std::string_view bytes) {
  std::array<Integer, 2> sides{};
  std::size_t at = 2;
  for (Integer& side : sides) {
    while (at < bytes.size() &&
           (std::isspace(static_cast<unsigned char>(bytes[at])) || bytes[at] == '#')) {
      at = bytes[at] == '#' ? bytes.find_first_of("\r\n", at) : at + 1;
    }
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789", at), bytes.size());
    if (at >= end) return std::nullopt;
    for (; at < end; ++at) {
      side = std::min<Integer>(10 * side + (bytes[at] - '0'), std::numeric_limits<int>::max());
    }
  }
  return cv::Size2l(sides[0], sides[1]);
}

Size tiff_size(std::string_view bytes) {
  constexpr Integer kColumns = 256, kRows = 257, kRowsOfStrip = 278, kColumnsOfTile = 322,
                    kRowsOfTile = 323, kOneStrip = 0xffffffff;
  const std::map<Integer, int> lengths{{1, 1}, {3, 2}, {4, 4}, {6, 1}, {8, 2}, {9, 4}};  // by type
  const bool big_endian = bytes.starts_with('M');
  const auto number = [&](std::size_t at, int length) {
    return number_at(bytes, at, length, big_endian);
  };
  const auto directory = static_cast<std::size_t>(number(4, 4));
  cv::Size2l size;
  for (Integer i = 0; i < number(directory, 2); ++i) {
    const std::size_t entry = directory + 2 + 12 * static_cast<std::size_t>(i);
    const Integer tag = number(entry, 2);
    const bool is_width = tag == kColumns || tag == kColumnsOfTile;
    if (!is_width && tag != kRows && tag != kRowsOfStrip && tag != kRowsOfTile) continue;
    const auto length = lengths.find(number(entry + 2, 2));
    if (length == lengths.end()) return std::nullopt;
    const Integer value = number(entry + 8, length->second);
    if (tag == kRowsOfStrip && value == kOneStrip) continue;
    Integer& side = is_width ? size.width : size.height;
    side = std::max(side, value);
  }
  return size;
}

/// Image size in the first chunk of a WebP file: lossy, lossless, or extended.
Size webp_size(std::string_view bytes) {
  constexpr Integer kSide = 0x3fff;
  const std::string_view chunk = bytes.substr(std::min<std::size_t>(12, bytes.size()), 4);
  const auto number = [&](std::size_t at, int length) {
    return number_at(bytes, at, length, false);
  };
  if (chunk == "VP8 ") return cv::Size2l(number(26, 2) & kSide, number(28, 2) & kSide);
  if (chunk == "VP8L") {
    const Integer sides = number(21, 4);
    return cv::Size2l((sides & kSide) + 1, (sides >> 14 & kSide) + 1);
  }
  if (chunk == "VP8X") return cv::Size2l(number(24, 3) + 1, number(27, 3) + 1);
  return std::nullopt;
}

/// Captures stderr during its lifetime. libpng and libjpeg report only there, and their text would
/// appear beside our own message. One instance at a time, and none while this program writes there.
class [[nodiscard]] Overheard {
 public:
  Overheard() : lock_(stderr_mutex()) {
    before_ = input::Descriptor(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
    if (!before_.is_open()) return;  // stderr is closed, or files are too many: capture nothing
    heard_ = input::Descriptor(::memfd_create("overheard", MFD_CLOEXEC));
    if (heard_.is_open()) ::dup2(heard_.get(), STDERR_FILENO);
  }
  ~Overheard() {
    if (heard_.is_open()) ::dup2(before_.get(), STDERR_FILENO);
  }

  std::string text() const {
    std::string heard(1000, '\0');
    const ssize_t got = heard_.is_open() ? ::pread(heard_.get(), heard.data(), heard.size(), 0) : 0;
    heard.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return heard;
  }

 private:
  std::lock_guard<std::mutex> lock_;
  input::Descriptor before_, heard_;
};

/// libjpeg invents data that it cannot read, and reports it. Excess bytes at the end do no harm.
bool is_damaged(std::string_view heard) {
  return heard.starts_with("Corrupt JPEG") &&
         heard.find("extraneous bytes before marker 0xd9") == heard.npos;
}

PictureError broken() {
  return PictureError("the picture is broken; give a whole one");
}

/// Takes a new handle.
std::unique_ptr<void, decltype(&tjDestroy)> turbojpeg(tjhandle handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return {handle, tjDestroy};
}

}  // namespace

std::mutex& stderr_mutex() {
  static std::mutex one;
  return one;
}

std::optional<cv::Size2l> picture_size(std::string_view bytes) {
  if (bytes.starts_with(kPng)) {
    return cv::Size2l(number_at(bytes, 16, 4, true), number_at(bytes, 20, 4, true));
  }
  if (bytes.starts_with(kJpeg)) return jpeg_size(bytes);
  if (bytes.starts_with("BM")) return bmp_size(bytes);
  if (bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') {
    return pnm_size(bytes);
  }
  if (bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.substr(8, 4) == "WEBP") {
    return webp_size(bytes);
  }
  constexpr std::string_view kLittle("II*\0", 4), kBig("MM\0*", 4);
  if (bytes.starts_with(kLittle) || bytes.starts_with(kBig)) return tiff_size(bytes);
  return std::nullopt;
}

cv::Mat decode_picture(std::string_view bytes, int flags) {
  const Size size = picture_size(bytes);
  if (!size) {
    throw PictureError(
        "this is no picture that can be read; give a PNG, JPEG, BMP, TIFF, WebP, PGM or PPM");
  }
  // divided, because the product of two 32-bit sides may overflow
  if (size->width > 0 && size->height > kMostPixels / size->width) {
    throw PictureError(fmt::format(
        "the picture has {} x {} pixels, and can have {} million in all; give a smaller one",
        size->width, size->height, kMostPixels / 1'000'000));
  }
  if (bytes.starts_with(kJpeg) && bytes.find(kJpegEnd, jpeg_frame(bytes)) == bytes.npos) {
    throw broken();  // for data in memory libjpeg does not report truncation
  }
  cv::Mat picture;
  const Overheard overheard;
  try {
    picture = media().imdecode(
        cv::Mat(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data())), flags);
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) throw;
  }
  if (picture.empty() || is_damaged(overheard.text())) throw broken();
  return picture;
}

std::string encode_jpeg(const cv::Mat3b& picture, int quality) {
  const auto jpeg = turbojpeg(tjInitCompress());
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int failed =
      tjCompress2(jpeg.get(), picture.data, picture.cols, static_cast<int>(picture.step),
                  picture.rows, TJPF_BGR, &bytes, &size, TJSAMP_420, quality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, decltype(&tjFree)> owner(bytes, tjFree);
  if (failed != 0) throw std::runtime_error(tjGetErrorStr2(jpeg.get()));
  return {reinterpret_cast<const char*>(bytes), size};
}

cv::Mat3b decode_jpeg(std::string_view bytes) {
  const cv::Size2l size = jpeg_size(bytes).value_or(cv::Size2l());
  cv::Mat3b picture(static_cast<int>(size.height), static_cast<int>(size.width));
  const auto jpeg = turbojpeg(tjInitDecompress());
  if (picture.empty() ||
      tjDecompress2(jpeg.get(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                    picture.data, picture.cols, static_cast<int>(picture.step), picture.rows,
                    TJPF_BGR, TJFLAG_ACCURATEDCT) != 0) {
    throw broken();
  }
  return picture;
}

cv::Mat read_picture(const std::filesystem::path& file, const input::Source& where, int flags) {
  const std::string bytes = input::InputFile(file, kPictureFile, where).bytes();
  try {
    return decode_picture(bytes, flags);
  } catch (const PictureError& error) {
    const std::string name = where.file == file ? "" : "'" + file.string() + "': ";
    throw input::Error(where, name + error.what());
  }
}

}  // namespace lcs::sim
