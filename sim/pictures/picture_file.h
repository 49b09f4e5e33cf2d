/// \file
/// Images from files. One function decodes them all. It reads the size from the header and rejects
/// too large an image before it allocates pixels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "scenarios/input/error.h"

namespace lcs::sim {

/// The pixels of the largest camera, 8192 x 8192. In colour they take 200 MB.
inline constexpr std::int64_t kMostPixels = std::int64_t{8192} * 8192;

/// The fault of an image file, and the remedy.
class PictureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The size in the header of a PNG, JPEG, BMP, PGM, PPM, WebP or TIFF; absent for other formats.
/// For a TIFF: the size of its tiles or strips where they exceed the image.
std::optional<cv::Size2l> picture_size(std::string_view bytes);

/// Held while stderr is written, which `decode_picture` takes for what libraries write there.
std::mutex& stderr_mutex();

/// \param flags of `cv::imdecode`. \return never empty.
/// \throws PictureError for an unknown format, too many pixels, and a damaged or truncated image.
cv::Mat decode_picture(std::string_view bytes, int flags);

/// \name JPEG without OpenCV's codecs, which take a tenth of a second to load.
///@{
/// \param picture BGR, not empty. \param quality 1 to 100. \throws std::runtime_error
std::string encode_jpeg(const cv::Mat3b& picture, int quality);
/// Decodes the bytes of `encode_jpeg` as BGR. \throws PictureError for a damaged picture.
cv::Mat3b decode_jpeg(std::string_view bytes);
///@}

/// \param where the place that names the file; errors cite it.
/// \throws input::Error for a file that `input::InputFile` or `decode_picture` rejects.
cv::Mat read_picture(const std::filesystem::path& file, const input::Source& where, int flags);

}  // namespace lcs::sim
