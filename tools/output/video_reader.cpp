#include "tools/output/video_reader.h"

#include <cstdlib>
#include <optional>
#include <string>

namespace lcs::bench {
namespace {

/// As OpenCV hands options to `avformat_open_input`: it reads them each time that it opens a video.
constexpr const char* kOptionsVariable = "OPENCV_FFMPEG_CAPTURE_OPTIONS";
constexpr const char* kOptions =
    "protocol_whitelist;file|format_whitelist;mov,avi,matroska,mpeg,mpegts,flv,asf,ogg";

/// A variable of the environment, for as long as it lives: the process may be somebody else's.
class Variable {
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

cv::VideoCapture open_video(const std::filesystem::path& file) {
  // FFmpeg writes to stderr what is told here anyway. Read once, at its first use.
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0);
  const Variable options(kOptionsVariable, kOptions);
  // A relative name might look like a protocol's.
  return cv::VideoCapture(std::filesystem::absolute(file).string(), cv::CAP_FFMPEG);
}

}  // namespace lcs::bench
