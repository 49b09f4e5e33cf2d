/// \file
/// The library that `media()` loads.
#include <opencv2/imgcodecs.hpp>

#include "sim/pictures/media.h"

extern "C" const lcs::sim::Media lcs_media_functions;
const lcs::sim::Media lcs_media_functions = {
    &cv::imencode,
    &cv::imdecode,
    [](const std::string& file) {
      return std::make_unique<cv::VideoCapture>(file, cv::CAP_FFMPEG);
    },
    [](const std::string& file, const char* codec, double frames_per_second,
       const cv::Size& size_px) {
      const int code = cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]);
      return std::make_unique<cv::VideoWriter>(file, cv::CAP_FFMPEG, code, frames_per_second,
                                               size_px);
    },
};
