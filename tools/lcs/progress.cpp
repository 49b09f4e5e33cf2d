#include "tools/lcs/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

namespace lcs::tools {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kBarPeriod(100);
constexpr int kLines = 4;
constexpr const char* kWipe = "\r\x1b[K";

}  // namespace

Progress::Progress(std::string name, int frames, bool quiet)
    : name_(std::move(name)),
      frames_(frames),
      style_(quiet                     ? Style::none
             : ::isatty(STDERR_FILENO) ? Style::bar
                                       : Style::lines) {}

Progress::~Progress() {
  if (style_ == Style::bar) fmt::print(stderr, "{}", kWipe);
}

void Progress::show(int done) {
  if (style_ == Style::bar) show_bar(done);
  if (style_ == Style::lines) show_line(done);
}

void Progress::show_bar(int done) {
  const Clock::time_point now = Clock::now();
  if (now - shown_ < kBarPeriod && done < frames_) return;
  shown_ = now;
  const int filled = kBarWidth * done / frames_;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  fmt::print(stderr, "{}{} [{:#<{}}{:.<{}}] {}/{} frames, {:.0f} s left", kWipe, name_, "", filled,
             "", kBarWidth - filled, done, frames_, seconds / done * (frames_ - done));
}

void Progress::show_line(int done) {
  // A line where another quarter became full.
  if (done * kLines / frames_ == (done - 1) * kLines / frames_) return;
  fmt::print(stderr, "{}: {}/{} frames\n", name_, done, frames_);
}

}  // namespace lcs::tools
