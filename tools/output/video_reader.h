/// \file
/// The one way in which a video is opened.
#pragma once

#include <filesystem>
#include <opencv2/videoio.hpp>

namespace lcs::bench {

/// FFmpeg by itself guesses: it draws text as pictures, and follows playlists to other files. Here
/// it reads only MP4, MOV, AVI, MKV, WebM, MPEG, FLV, ASF and OGG, and no other file.
/// \return not opened for anything else.
cv::VideoCapture open_video(const std::filesystem::path& file);

}  // namespace lcs::bench
