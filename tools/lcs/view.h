/// \file
/// A window that shows a run while it is computed, with keys to pause, step and close.
#pragma once

#include <chrono>
#include <functional>
#include <opencv2/core.hpp>
#include <string>

namespace lcs::tools {

/// Keyboard control of the playback, independent of the window.
class Player {
 public:
  /// Processes window events and waits up to `wait_ms` for a key. \return as `cv::waitKey`: -1
  /// without a key; `kClosed` if the window was closed.
  using Keys = std::function<int(int wait_ms)>;
  static constexpr int kClosed = -2;

  /// \param frames_per_second upper limit of the playback rate.
  Player(Keys keys, double frames_per_second);

  /// To be called after a frame is shown. Blocks until the next frame is due.
  /// \return false if the user ended the playback.
  bool after_frame();

  /// To be called after the last frame. Blocks until a key is pressed.
  void after_last_frame();

 private:
  Keys keys_;
  std::chrono::milliseconds frame_;
  bool paused_ = false;
};

/// The window. While it waits, it may throw the exceptions of `check_interrupted`.
class View {
 public:
  /// \throws std::runtime_error if there is no display; the message states the remedy.
  View(const std::string& title, double frames_per_second);
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  /// Shows a frame. \param sheet BGR. \return whether the window is still open.
  bool show(const cv::Mat3b& sheet);
  /// Shows the last frame until a key is pressed or a signal arrives.
  void hold();

 private:
  int key(int wait_ms) const;

  std::string title_;
  Player player_;
  bool is_open_ = true;
  bool has_size_ = false;  ///< whether the size of the first sheet was applied
};

}  // namespace lcs::tools
