/// \file
/// The library that `media()` loads.
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
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

/// Encodes H.264 into MP4, or MPEG-4 part 2 if FFmpeg lacks the first. OpenCV's writer leaves x264
/// at its preset "medium", with which a run's video takes longer than the run.
class Mp4 : public lcs::sim::VideoFile {
 public:
  Mp4(const std::string& file, double frames_per_second, const cv::Size& size_px) {
    av_log_set_level(AV_LOG_QUIET);  // the caller reports errors
    const AVCodec* encoder = avcodec_find_encoder(AV_CODEC_ID_H264);
    if (!encoder) encoder = avcodec_find_encoder(AV_CODEC_ID_MPEG4);
    avformat_alloc_output_context2(&format_, nullptr, "mp4", nullptr);
    if (!encoder || !format_ || !(codec_ = avcodec_alloc_context3(encoder))) return;
    codec_->width = frame_->width = size_px.width;
    codec_->height = frame_->height = size_px.height;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    frame_->format = AV_PIX_FMT_YUV420P;
    codec_->time_base = av_inv_q(av_d2q(frames_per_second, 1 << 16));
    codec_->thread_count = 1;  // the bytes would depend on the number of threads
    codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // as MP4 has it
    AVDictionary* options = nullptr;
    av_dict_set(&options, "preset", "veryfast", 0);
    stream_ = avformat_new_stream(format_, encoder);
    to_yuv_ =
        sws_getContext(size_px.width, size_px.height, AV_PIX_FMT_BGR24, size_px.width,
                       size_px.height, codec_->pix_fmt, SWS_BICUBIC, nullptr, nullptr, nullptr);
    is_open_ = to_yuv_ && stream_ && av_frame_get_buffer(frame_, 0) >= 0 &&
               avcodec_open2(codec_, encoder, &options) >= 0 &&
               avcodec_parameters_from_context(stream_->codecpar, codec_) >= 0 &&
               avio_open(&format_->pb, ("file:" + file).c_str(), AVIO_FLAG_WRITE) >= 0 &&
               avformat_write_header(format_, nullptr) >= 0;
    av_dict_free(&options);
  }
  ~Mp4() override {
    if (format_) avio_closep(&format_->pb);
    avformat_free_context(format_);
    sws_freeContext(to_yuv_);
    avcodec_free_context(&codec_);
    av_frame_free(&frame_);
    av_packet_free(&packet_);
  }
  Mp4(const Mp4&) = delete;
  Mp4& operator=(const Mp4&) = delete;

  bool is_open() const { return is_open_; }
  bool write(const cv::Mat3b& picture) override {
    const auto step = static_cast<int>(picture.step);
    frame_->pts = next_++;
    return av_frame_make_writable(frame_) >= 0 &&  // the encoder may keep the last one
           sws_scale(to_yuv_, &picture.data, &step, 0, picture.rows, frame_->data,
                     frame_->linesize) == picture.rows &&
           encode(frame_);
  }
  bool close() override {
    return encode(nullptr) && av_write_trailer(format_) >= 0 && avio_closep(&format_->pb) >= 0;
  }

 private:
  /// \param frame null after the last one. \return whether all packets that came out were written.
  bool encode(const AVFrame* frame) {
    bool is_written = avcodec_send_frame(codec_, frame) >= 0;
    while (avcodec_receive_packet(codec_, packet_) >= 0) {
      packet_->duration = 1;  // else the last frame has none, and the rate is not the one asked for
      av_packet_rescale_ts(packet_, codec_->time_base, stream_->time_base);
      is_written &= av_interleaved_write_frame(format_, packet_) >= 0;
    }
    return is_written;
  }

  AVFormatContext* format_ = nullptr;
  AVCodecContext* codec_ = nullptr;
  AVStream* stream_ = nullptr;
  AVFrame* frame_ = av_frame_alloc();
  AVPacket* packet_ = av_packet_alloc();
  SwsContext* to_yuv_ = nullptr;
  std::int64_t next_ = 0;
  bool is_open_ = false;
};

}  // namespace

extern "C" const lcs::sim::Media lcs_media_functions;
const lcs::sim::Media lcs_media_functions = {
    &cv::imencode,
    &cv::imdecode,
    &video_times,
    [](const std::string& file) {
      return std::make_unique<cv::VideoCapture>(file, cv::CAP_FFMPEG);
    },
    [](const std::string& file, double frames_per_second,
       const cv::Size& size_px) -> std::unique_ptr<lcs::sim::VideoFile> {
      auto video = std::make_unique<Mp4>(file, frames_per_second, size_px);
      return video->is_open() ? std::move(video) : nullptr;
    },
};
