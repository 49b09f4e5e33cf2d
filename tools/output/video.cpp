#include "tools/output/video.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string>

namespace lcs::output {
namespace {

/// FFmpeg does not report why a write fails. \throws OutputError with the system's reason.
void require_writable(const std::filesystem::path& path) {
  constexpr std::size_t kSome = 1 << 20;
  files::write_file(path, std::string(kSome, '\0'));
}

}  // namespace

Video::Video(const std::filesystem::path& path, cv::Size size_px, double frames_per_second)
    : path_(path), file_(sim::media().write_video(path.string(), frames_per_second, size_px)) {
  if (file_) return;
  require_writable(path);
  throw files::OutputError(
      fmt::format("FFmpeg cannot write {}; install one with H.264 or MPEG-4, or use --no-video",
                  path.string()));
}

void Video::close() {
  if (file_->close() && is_whole_) return;
  require_writable(path_);
  throw files::OutputError(
      fmt::format("{} did not become whole; make room there, choose another folder with --out, or "
                  "use --no-video",
                  path_.string()));
}

std::unique_ptr<cv::VideoCapture> open_video(const std::filesystem::path& file) {
  // Silences FFmpeg's messages, as errors are reported here. FFmpeg reads it once, at first use.
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0);
  // OpenCV passes these options to `avformat_open_input`; it reads them at each opening.
  constexpr const char* kOptions = "OPENCV_FFMPEG_CAPTURE_OPTIONS";
  const char* const set = std::getenv(kOptions);
  const std::optional<std::string> before = set ? std::optional(std::string(set)) : std::nullopt;
  const std::string ours =
      fmt::format("protocol_whitelist;file|format_whitelist;{}", sim::kVideoFormats);
  ::setenv(kOptions, ours.c_str(), /*overwrite=*/1);
  // An absolute path cannot be mistaken for a protocol.
  auto video = sim::media().read_video(std::filesystem::absolute(file).string());
  before ? ::setenv(kOptions, before->c_str(), /*overwrite=*/1) : ::unsetenv(kOptions);
  return video;
}

}  // namespace lcs::output
