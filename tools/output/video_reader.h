/// \file
/// Opens video files safely; all videos are opened by this function.
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/videoio.hpp>

namespace lcs::bench {

/// By default FFmpeg guesses formats: it decodes text as pictures, and follows playlists to other
/// files. This reads only MP4, MOV, AVI, MKV, WebM, MPEG, FLV, ASF and OGG.
/// \return not opened for any other format.
std::unique_ptr<cv::VideoCapture> open_video(const std::filesystem::path& file);

}  // namespace lcs::bench
