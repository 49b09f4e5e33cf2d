#include "tools/lcs/view.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "sim/base/trial.h"
#include "sim/pictures/media.h"
#include "tools/lcs/interrupt.h"

namespace lcs::tools {
namespace {

constexpr int kPoll_ms = 50;  // interval of the checks for signals
constexpr int kEscape = 27;

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// Tries to open a window in a child process, because OpenCV ends the process if that fails.
void require_display(const std::string& title) {
  const bool is_named = is_set("DISPLAY") || is_set("WAYLAND_DISPLAY") || is_set("QT_QPA_PLATFORM");
  if (is_named &&
      sim::try_in_child([&] { sim::windows().named_window(title, cv::WINDOW_NORMAL); }).fine) {
    return;
  }
  throw std::runtime_error(
      is_named ? "--view: no window can be opened on the display that DISPLAY or WAYLAND_DISPLAY "
                 "names; correct it, or leave --view out: video.mp4 shows the same"
               : "--view: there is no display (DISPLAY and WAYLAND_DISPLAY are not set); leave it "
                 "out: video.mp4 shows the same");
}

}  // namespace

Player::Player(Keys keys, double frames_per_second)
    : keys_(std::move(keys)), frame_(std::lround(1000 / frames_per_second)) {}

bool Player::after_frame() {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + frame_;
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    const int wait_ms = paused_ ? kPoll_ms : std::clamp(static_cast<int>(left), 1, kPoll_ms);
    switch (const int key = keys_(wait_ms); key) {
      case kClosed:
      case kEscape:
      case 'q':
        return false;
      case ' ':
        paused_ = !paused_;
        break;
      case '.':
        paused_ = true;
        return true;  // advance by one frame
      default:
        break;
    }
    if (!paused_ && Clock::now() >= end) return true;
  }
}

void Player::after_last_frame() {
  while (keys_(kPoll_ms) == -1) {
  }
}

View::View(const std::string& title, double frames_per_second)
    : title_(title + ": space pauses, . goes on by one frame, q closes; the last frame stays"),
      player_([this](int wait_ms) { return key(wait_ms); }, frames_per_second) {
  require_display(title_);
  sim::windows().named_window(title_,
                              cv::WINDOW_NORMAL | cv::WINDOW_KEEPRATIO | cv::WINDOW_GUI_NORMAL);
}

View::~View() {
  if (is_open_) sim::windows().destroy_all();
}

int View::key(int wait_ms) const {
  check_interrupted();
  const int key = sim::windows().wait_key(wait_ms);
  const bool is_there = sim::windows().property(title_, cv::WND_PROP_VISIBLE) > 0;
  return is_there ? key : Player::kClosed;
}

bool View::show(const cv::Mat3b& sheet) {
  if (!std::exchange(has_size_, true)) sim::windows().resize(title_, sheet.size());
  sim::windows().show(title_, sheet);
  is_open_ = player_.after_frame();
  if (!is_open_) sim::windows().destroy_all();
  return is_open_;
}

void View::hold() {
  if (!is_open_) return;
  try {
    player_.after_last_frame();
  } catch (const Interrupted&) {
    // The run is complete: ignore the signal.
  }
}

}  // namespace lcs::tools
