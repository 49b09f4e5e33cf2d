#include "tools/sequence/png.h"

#include <fmt/format.h>
#include <spng.h>

#include <cstdlib>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace lcs::sequence {
namespace {

constexpr int kLevel = 1;  // of zlib; slower ones save a few percent of photographs

std::string encode(const cv::Mat& image, spng_color_type colour, int filters, spng_plte* palette) {
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> encoder(spng_ctx_new(SPNG_CTX_ENCODER),
                                                                    &spng_ctx_free);
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(image.cols);
  header.height = static_cast<std::uint32_t>(image.rows);
  header.bit_depth = image.depth() == CV_16U ? 16 : 8;
  header.color_type = static_cast<std::uint8_t>(colour);
  spng_set_option(encoder.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_set_option(encoder.get(), SPNG_IMG_COMPRESSION_LEVEL, kLevel);
  spng_set_option(encoder.get(), SPNG_FILTER_CHOICE, filters);
  spng_set_ihdr(encoder.get(), &header);
  if (palette) spng_set_plte(encoder.get(), palette);
  const cv::Mat whole = image.isContinuous() ? image : image.clone();
  int error = spng_encode_image(encoder.get(), whole.data, whole.total() * whole.elemSize(),
                                SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  std::size_t size = 0;
  const std::unique_ptr<char, decltype(&std::free)> bytes(
      error ? nullptr : static_cast<char*>(spng_get_png_buffer(encoder.get(), &size, &error)),
      &std::free);
  if (error) throw std::runtime_error(fmt::format("libspng: {}", spng_strerror(error)));
  return {bytes.get(), size};
}

}  // namespace

std::string encode_png(const cv::Mat& image, PngFilter filter) {
  const bool fits = !image.empty() && (image.depth() == CV_8U || image.depth() == CV_16U) &&
                    (image.channels() == 1 || image.channels() == 3);
  if (!fits) throw std::invalid_argument("PNG takes images of 8 or 16 bits with 1 or 3 channels");
  cv::Mat rgb;  // a picture of its own
  if (image.type() == CV_8UC3) cv::cvtColor(image, rgb, cv::COLOR_BGR2RGB);
  return encode(rgb.empty() ? image : rgb,
                image.channels() == 1 ? SPNG_COLOR_TYPE_GRAYSCALE : SPNG_COLOR_TYPE_TRUECOLOR,
                SPNG_FILTER_CHOICE_NONE << static_cast<int>(filter), nullptr);
}

std::string encode_png(const cv::Mat1b& indices, std::span<const Rgb> palette) {
  if (indices.empty() || palette.size() != 256) {
    throw std::invalid_argument("an indexed PNG needs pixels and a palette of 256 colours");
  }
  spng_plte colours{};
  colours.n_entries = 256;
  for (std::size_t i = 0; i < palette.size(); ++i) {
    const auto& [red, green, blue] = palette[i];
    colours.entries[i] = {red, green, blue, 255};
  }
  return encode(indices, SPNG_COLOR_TYPE_INDEXED, SPNG_DISABLE_FILTERING, &colours);
}

}  // namespace lcs::sequence
