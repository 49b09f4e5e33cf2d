#include "tools/output/video.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "sim/pictures/media.h"

namespace lcs::output {
namespace {

/// FFmpeg does not report why a write fails. \throws OutputError with the system's reason.
void require_writable(const std::filesystem::path& path) {
  constexpr std::size_t kSome = 1 << 20;
  files::write_file(path, std::string(kSome, '\0'));
}

/// Sets an environment variable for its lifetime, then restores it.
class [[nodiscard]] Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value, /*overwrite=*/1);
  }
  ~Variable() {
    if (before_) {
      ::setenv(name_, before_->c_str(), /*overwrite=*/1);
    } else {
      ::unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace

Video::Video(const std::filesystem::path& path, cv::Size size_px, double frames_per_second)
    : path_(path) {
  // Silences FFmpeg's messages, as errors are reported here. FFmpeg reads it once, at first use.
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0);
  for (const char* const codec : {"avc1", "mp4v"}) {
    writer_ = sim::media().write_video(path.string(), codec, frames_per_second, size_px);
    if (writer_->isOpened()) return;
  }
  require_writable(path);
  throw files::OutputError(fmt::format(
      "OpenCV cannot write {}; install an FFmpeg with H.264 or MPEG-4, or use --no-video",
      path.string()));
}

void Video::write(const cv::Mat3b& frame) {
  writer_->write(frame);
  ++frames_;
}

void Video::close() {
  writer_->release();
  const auto written = open_video(path_);
  const std::string first =
      files::beginning(path_, 8);  // FFmpeg reads a file without this box, too
  if (!first.ends_with("ftyp") || !written->isOpened() ||
      static_cast<int>(written->get(cv::CAP_PROP_FRAME_COUNT)) != frames_) {
    require_writable(path_);
    throw files::OutputError(
        fmt::format("{} did not become whole; make room there, choose another folder with --out, "
                    "or use --no-video",
                    path_.string()));
  }
}

std::unique_ptr<cv::VideoCapture> open_video(const std::filesystem::path& file) {
  // Silences FFmpeg's messages, as errors are reported here. FFmpeg reads it once, at first use.
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0);
  // OpenCV passes these options to `avformat_open_input`; it reads them at each opening.
  const Variable options(
      "OPENCV_FFMPEG_CAPTURE_OPTIONS",
      fmt::format("protocol_whitelist;file|format_whitelist;{}", sim::kVideoFormats).c_str());
  // An absolute path cannot be mistaken for a protocol.
  return sim::media().read_video(std::filesystem::absolute(file).string());
}

}  // namespace lcs::output
