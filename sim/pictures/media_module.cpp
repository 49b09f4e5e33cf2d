/// \file
/// The library that `media()` loads.
extern "C" {
#include <libavformat/avformat.h>
}

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <vector>

#include "sim/pictures/media.h"

namespace {

constexpr AVRational kNanoseconds{1, 1'000'000'000};

/// The first stream of pictures, as OpenCV takes it; null if there is none.
const AVStream* first_video(const AVFormatContext& format) {
  for (unsigned i = 0; i < format.nb_streams; ++i) {
    if (format.streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO) return format.streams[i];
  }
  return nullptr;
}

/// Whether a format is a stream of pictures alone, for which FFmpeg invents a rate.
bool is_bare(std::string_view format) {
  return format == "h264" || format == "hevc" || format == "mjpeg" || format == "jpeg_pipe";
}

/// Whether times go back only as far as pictures are decoded before they are shown. Parts of a
/// stream that were joined begin anew.
bool are_in_order(const std::vector<std::int64_t>& t_ns) {
  constexpr std::size_t kMostReordered = 32;
  std::int64_t before = INT64_MIN;  // the latest of all but the last pictures
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    if (i >= kMostReordered) before = std::max(before, t_ns[i - kMostReordered]);
    if (t_ns[i] < before) return false;
  }
  return true;
}

lcs::sim::VideoTimes video_times(const std::string& file) {
  lcs::sim::VideoTimes times;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "file", 0);
  av_dict_set(&options, "format_whitelist", lcs::sim::kVideoFormats, 0);
  AVFormatContext* format = nullptr;
  const int opened = avformat_open_input(&format, file.c_str(), nullptr, &options);
  av_dict_free(&options);
  if (opened < 0) return times;
  const bool is_known = avformat_find_stream_info(format, nullptr) >= 0;
  const AVStream* stream = is_known ? first_video(*format) : nullptr;
  times.are_stated = stream && !is_bare(format->iformat->name);
  std::int64_t left_out = 0;  // by a list of edits
  std::vector<std::int64_t> pts, dts;
  AVPacket* packet = av_packet_alloc();
  while (stream && packet && av_read_frame(format, packet) >= 0) {
    if (packet->stream_index == stream->index) {
      if ((packet->flags & AV_PKT_FLAG_DISCARD) != 0) {
        ++left_out;
      } else {
        pts.push_back(packet->pts);
        dts.push_back(packet->dts);
      }
    }
    av_packet_unref(packet);
  }
  if (stream) times.counted = stream->nb_frames - left_out;
  // AVI and MPEG's program streams lack some presentation times. Decoding times are as far apart.
  const auto is_missing = [](std::int64_t time) { return time == AV_NOPTS_VALUE; };
  if (std::ranges::any_of(pts, is_missing)) pts = dts;
  times.are_stated = times.are_stated && std::ranges::none_of(pts, is_missing);
  for (const std::int64_t time : pts) {
    times.t_ns.push_back(times.are_stated ? av_rescale_q(time, stream->time_base, kNanoseconds)
                                          : 0);
  }
  av_packet_free(&packet);
  avformat_close_input(&format);
  times.are_stated = times.are_stated && are_in_order(times.t_ns);
  std::ranges::sort(times.t_ns);
  return times;
}

}  // namespace

extern "C" const lcs::sim::Media lcs_media_functions;
const lcs::sim::Media lcs_media_functions = {
    &cv::imencode,
    &cv::imdecode,
    &video_times,
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
