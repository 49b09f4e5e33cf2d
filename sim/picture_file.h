/// \file
/// Pictures from files. One function decodes them all: it knows their size, and refuses too large a
/// one, before anything is allocated for the pixels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "scenarios/scenario.h"

namespace lcs::sim {

/// As many as the largest camera has, 8192 x 8192. Decoded to colours they take 200 MB.
inline constexpr std::int64_t kMostPixels = std::int64_t{8192} * 8192;

/// What is wrong with a picture, and what to do.
class PictureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the header of a PNG, JPEG, BMP, PGM, PPM or TIFF says; none for all else. A TIFF is decoded
/// in tiles or strips: where those are larger than the picture, their size.
std::optional<cv::Size2l> picture_size(std::string_view bytes);

/// \param flags of `cv::imdecode`. \return never empty.
/// \throws PictureError for another format, too many pixels, and a picture that is damaged or cut
///   off.
cv::Mat decode_picture(std::string_view bytes, int flags);

/// \param where the file is named, which is blamed for it.
/// \throws scenario::Error for what `scenario::InputFile` or `decode_picture` refuse.
cv::Mat read_picture(const std::filesystem::path& file, const scenario::Source& where, int flags);

}  // namespace lcs::sim
