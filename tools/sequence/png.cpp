#include "tools/sequence/png.h"

#include <libdeflate.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "tools/files/output_file.h"

namespace lcs::sequence {
namespace {

// "Portable Network Graphics (PNG) Specification", W3C.
constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
enum ColourType : char { kGrey = 0, kColour = 2, kIndexed = 3 };

void append_big_endian(std::string& to, std::uint32_t number) {
  for (const int shift : {24, 16, 8, 0}) to += static_cast<char>(number >> shift & 0xff);
}

/// Appends length, type, data, and a checksum of type and data.
void append_chunk(std::string& to, std::string_view type, std::string_view data) {
  append_big_endian(to, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = to.size();
  to += type;
  to += data;
  append_big_endian(to, libdeflate_crc32(0, to.data() + begin, to.size() - begin));
}

std::string header(const cv::Mat& image, ColourType colour) {
  std::string data;
  append_big_endian(data, static_cast<std::uint32_t>(image.cols));
  append_big_endian(data, static_cast<std::uint32_t>(image.rows));
  data += image.depth() == CV_16U ? '\x10' : '\x08';
  data += static_cast<char>(colour);
  data.append(3, '\0');  // the standard compression and filter method, not interlaced
  return data;
}

/// Converts a row to the file format: big-endian, red first.
void lay_out(const cv::Mat& image, int y, std::vector<unsigned char>& row) {
  if (image.type() == CV_8UC3) {
    const cv::Vec3b* from = image.ptr<cv::Vec3b>(y);
    for (int x = 0; x < image.cols; ++x) {
      for (int c = 0; c < 3; ++c) row[static_cast<std::size_t>(3 * x + c)] = from[x][2 - c];
    }
  } else if (image.depth() == CV_16U) {
    const std::uint16_t* from = image.ptr<std::uint16_t>(y);
    for (std::size_t i = 0; i < row.size() / 2; ++i) {
      row[2 * i] = static_cast<unsigned char>(from[i] >> 8);
      row[2 * i + 1] = static_cast<unsigned char>(from[i] & 0xff);
    }
  } else {
    std::copy_n(image.ptr(y), row.size(), row.begin());
  }
}

/// Each row of the result: the filter's code, then the filtered bytes.
std::string filtered(const cv::Mat& image, PngFilter filter) {
  const std::size_t pixel = image.elemSize();
  std::vector<unsigned char> row(static_cast<std::size_t>(image.cols) * pixel), above(row.size());
  std::string all((row.size() + 1) * static_cast<std::size_t>(image.rows), '\0');
  char* to = all.data();
  for (int y = 0; y < image.rows; ++y) {
    lay_out(image, y, row);
    *to++ = static_cast<char>(filter);
    std::ranges::copy(row, to);
    if (filter == PngFilter::sub) {
      for (std::size_t i = pixel; i < row.size(); ++i) {
        to[i] = static_cast<char>(row[i] - row[i - pixel]);
      }
    } else if (filter == PngFilter::up) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        to[i] = static_cast<char>(row[i] - above[i]);
      }
      above.swap(row);
    }
    to += row.size();
  }
  return all;
}

std::string encode(const cv::Mat& image, ColourType colour, PngFilter filter,
                   std::string_view palette) {
  std::string bytes(kSignature);
  append_chunk(bytes, "IHDR", header(image, colour));
  if (!palette.empty()) append_chunk(bytes, "PLTE", palette);
  append_chunk(bytes, "IDAT", files::compressed(filtered(image, filter), files::Packing::zlib));
  append_chunk(bytes, "IEND", "");
  return bytes;
}

}  // namespace

std::string encode_png(const cv::Mat& image, PngFilter filter) {
  const bool fits = !image.empty() && (image.depth() == CV_8U || image.depth() == CV_16U) &&
                    (image.channels() == 1 || image.channels() == 3);
  if (!fits) throw std::invalid_argument("PNG takes images of 8 or 16 bits with 1 or 3 channels");
  return encode(image, image.channels() == 1 ? kGrey : kColour, filter, "");
}

std::string encode_png(const cv::Mat1b& indices, std::span<const Rgb> palette) {
  if (indices.empty() || palette.size() != 256) {
    throw std::invalid_argument("an indexed PNG needs pixels and a palette of 256 colours");
  }
  std::string colours;
  for (const Rgb& colour : palette) colours.append(colour.begin(), colour.end());
  return encode(indices, kIndexed, PngFilter::none, colours);
}

}  // namespace lcs::sequence
