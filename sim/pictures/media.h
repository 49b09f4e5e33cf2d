/// \file
/// OpenCV's codecs, windows and optical flow, loaded when they are first used. With the libraries
/// that they link themselves (GDAL, FFmpeg, GTK, Protobuf) they are most of the time in which a
/// program starts.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/highgui.hpp>
#include <opencv2/video/tracking.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

namespace lcs::sim {

/// The formats of videos that FFmpeg may open, as its option format_whitelist.
inline constexpr const char* kVideoFormats =
    "mov,avi,matroska,mpeg,mpegts,flv,asf,ogg,h264,hevc,mjpeg,jpeg_pipe";

/// The times of all pictures of a video, in the order in which they are shown.
struct VideoTimes {
  std::vector<std::int64_t> t_ns;
  /// By the file. Bare streams of pictures state none; where videos were joined, times go back.
  bool are_stated = false;
  std::int64_t counted = 0;  ///< pictures by the file's header; 0: it does not count them
};

/// A video that is being written.
class VideoFile {
 public:
  virtual ~VideoFile() = default;
  /// \return whether all is well; an error may be noticed at a later frame.
  virtual bool write(const cv::Mat3b& picture) = 0;
  /// Ends the file. \return as `write`.
  virtual bool close() = 0;
};

/// Functions of OpenCV's imgcodecs and videoio, and of FFmpeg. The objects' virtual functions need
/// no linking.
struct Media {
  bool (*imencode)(const cv::String& extension, cv::InputArray picture, std::vector<uchar>& bytes,
                   const std::vector<int>& parameters);
  cv::Mat (*imdecode)(cv::InputArray bytes, int flags);
  /// Without decoding a picture. OpenCV has a picture's time only after it is decoded, and loses
  /// the times of the last pictures. Empty if the file is no video.
  VideoTimes (*video_times)(const std::string& file);
  /// By FFmpeg; not opened if it cannot.
  std::unique_ptr<cv::VideoCapture> (*read_video)(const std::string& file);
  /// An MP4 file. \param size_px even. \return null if FFmpeg cannot encode or open it.
  std::unique_ptr<VideoFile> (*write_video)(const std::string& file, double frames_per_second,
                                            const cv::Size& size_px);
};

/// Functions of OpenCV's highgui.
struct Windows {
  decltype(&cv::namedWindow) named_window;
  decltype(&cv::destroyAllWindows) destroy_all;
  decltype(&cv::waitKey) wait_key;
  decltype(&cv::getWindowProperty) property;
  void (*resize)(const cv::String& title, const cv::Size& size_px);
  void (*show)(const cv::String& title, cv::InputArray picture);
};

/// Functions of OpenCV's video.
struct OpticalFlow {
  decltype(&cv::buildOpticalFlowPyramid) build_pyramid;
  decltype(&cv::calcOpticalFlowPyrLK) lucas_kanade;
  decltype(&cv::DISOpticalFlow::create) dis;
};

/// \throws std::runtime_error if the library that this program was installed with is not there.
const Media& media();
const Windows& windows();
const OpticalFlow& optical_flow();

}  // namespace lcs::sim
