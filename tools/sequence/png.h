/// \file
/// PNG files by libspng, with optional palettes, which OpenCV does not write.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>

namespace lcs::sequence {

using Rgb = std::array<std::uint8_t, 3>;

/// PNG's filter for each row before compression.
enum class PngFilter : unsigned char {
  none = 0,  ///< large areas of one value
  sub = 1,   ///< differences from the pixel to the left
  up = 2,    ///< differences from the pixel above
};

/// \param image 8 or 16 bits; 1 channel, or 3 in the order red, green, blue (8 bits: blue, green,
///   red, as in OpenCV).
/// \throws std::invalid_argument for any other image, std::runtime_error without memory.
std::string encode_png(const cv::Mat& image, PngFilter filter);

/// An indexed image: each pixel is an index into the palette. \throws as `encode_png`.
std::string encode_png(const cv::Mat1b& indices, std::span<const Rgb> palette);

}  // namespace lcs::sequence
