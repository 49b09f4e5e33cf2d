/// \file
/// Pictures as the bytes of PNG files, compressed by libdeflate: two to three times as fast as
/// OpenCV's writer or libpng by zlib, and smaller, and with a palette where one is asked for.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>

namespace lcs::sequence {

using Rgb = std::array<std::uint8_t, 3>;

/// What the rows of a picture are compressed by.
enum class PngFilter : unsigned char {
  none = 0,  ///< large areas of one value
  sub = 1,   ///< differences from the pixel to the left
  up = 2,    ///< differences from the pixel above
};

/// \param image 8 or 16 bits, 1 channel, or 3 in the order red, green, blue (8 bits: blue, green,
/// red, as OpenCV has pictures).
/// \throws std::invalid_argument for any other image, std::bad_alloc.
std::string encode_png(const cv::Mat& image, PngFilter filter);

/// An indexed picture: each pixel is a place in the palette. \throws as `encode_png`.
std::string encode_png(const cv::Mat1b& indices, std::span<const Rgb> palette);

}  // namespace lcs::sequence
