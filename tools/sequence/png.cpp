#include "tools/sequence/png.h"

#include <png.h>
#include <zlib.h>

#include <bit>
#include <stdexcept>
#include <vector>

namespace lcs::sequence {
namespace {

constexpr int kLevel = 1;  // the next ones take twice the time for a few per cent

[[noreturn]] void fail(png_structp, png_const_charp message) {
  throw std::runtime_error(std::string("PNG: ") + message);
}
void ignore(png_structp, png_const_charp) {}

void append(png_structp png, png_bytep data, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}
void flush(png_structp) {}

class Encoder {
 public:
  explicit Encoder(std::string& to)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore)),
        info_(png_create_info_struct(png_)) {
    png_set_write_fn(png_, &to, append, flush);
    png_set_compression_level(png_, kLevel);
    png_set_compression_buffer_size(png_, 1 << 16);
  }
  ~Encoder() { png_destroy_write_struct(&png_, &info_); }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  png_structp png() { return png_; }
  png_infop info() { return info_; }

  void write(const cv::Mat& image, int colour_type, int filter, int strategy) {
    const int bits = image.depth() == CV_16U ? 16 : 8;
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(image.cols),
                 static_cast<png_uint_32>(image.rows), bits, colour_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, filter);
    png_set_compression_strategy(png_, strategy);
    png_write_info(png_, info_);
    if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
    if (image.type() == CV_8UC3) png_set_bgr(png_);
    for (int y = 0; y < image.rows; ++y) png_write_row(png_, image.ptr<png_byte>(y));
    png_write_end(png_, nullptr);
  }

 private:
  png_structp png_;
  png_infop info_;
};

int flag_of(PngFilter filter) {
  switch (filter) {
    case PngFilter::none:
      return PNG_FILTER_NONE;
    case PngFilter::sub:
      return PNG_FILTER_SUB;
    case PngFilter::up:
      return PNG_FILTER_UP;
  }
  throw std::invalid_argument("no such PNG filter");
}

}  // namespace

std::string encode_png(const cv::Mat& image, PngFilter filter) {
  const bool fits = !image.empty() && (image.depth() == CV_8U || image.depth() == CV_16U) &&
                    (image.channels() == 1 || image.channels() == 3);
  if (!fits) throw std::invalid_argument("PNG takes images of 8 or 16 bits with 1 or 3 channels");
  std::string bytes;
  bytes.reserve(image.total() * image.elemSize() / 2);
  Encoder(bytes).write(image, image.channels() == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                       flag_of(filter), filter == PngFilter::none ? Z_DEFAULT_STRATEGY : Z_RLE);
  return bytes;
}

std::string encode_png(const cv::Mat1b& indices, std::span<const Rgb> palette) {
  if (indices.empty() || palette.size() != 256) {
    throw std::invalid_argument("an indexed PNG needs pixels and a palette of 256 colours");
  }
  std::vector<png_color> colours;
  for (const Rgb& c : palette) colours.push_back({c[0], c[1], c[2]});
  std::string bytes;
  Encoder encoder(bytes);
  png_set_PLTE(encoder.png(), encoder.info(), colours.data(), static_cast<int>(colours.size()));
  encoder.write(indices, PNG_COLOR_TYPE_PALETTE, PNG_FILTER_NONE, Z_DEFAULT_STRATEGY);
  return bytes;
}

}  // namespace lcs::sequence
