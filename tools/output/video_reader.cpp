#include "tools/output/video_reader.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "sim/pictures/media.h"

namespace lcs::bench {
namespace {

/// Options that OpenCV passes to `avformat_open_input`; it reads them at each opening.
constexpr const char* kOptionsVariable = "OPENCV_FFMPEG_CAPTURE_OPTIONS";
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

std::unique_ptr<cv::VideoCapture> open_video(const std::filesystem::path& file) {
  // Silences FFmpeg's messages, as errors are reported here. FFmpeg reads it once, at first use.
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0);
  const Variable options(
      kOptionsVariable,
      fmt::format("protocol_whitelist;file|format_whitelist;{}", sim::kVideoFormats).c_str());
  // An absolute path cannot be mistaken for a protocol.
  return sim::media().read_video(std::filesystem::absolute(file).string());
}

}  // namespace lcs::bench
