/// \file
/// A window that shows a run while it goes on: pause, step, close.
#pragma once

#include <chrono>
#include <functional>
#include <opencv2/core.hpp>
#include <string>

namespace lcs::tools {

/// What keys do to the frames that are shown; knows no window.
class Player {
 public:
  /// Shows what is pending and waits for a key for up to so many ms. \return as `cv::waitKey`; -1
  /// for none, `kClosed` where the window is gone.
  using Keys = std::function<int(int wait_ms)>;
  static constexpr int kClosed = -2;

  /// \param frames_per_second no frame is left behind sooner.
  Player(Keys keys, double frames_per_second);

  /// To be called when a frame is on the screen: comes back when the next one may come.
  /// \return false where nobody wants to see more.
  bool after_frame();

  /// To be called after the last frame: comes back at any key.
  void after_last_frame();

 private:
  Keys keys_;
  std::chrono::milliseconds frame_;
  bool paused_ = false;
};

/// The window itself. While it waits it throws what `check_interrupted` throws.
class View {
 public:
  /// \throws std::runtime_error where there is no display, with what to do.
  View(const std::string& title, double frames_per_second);
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  /// \param sheet BGR. \return whether the window is still open.
  bool show(const cv::Mat3b& sheet);
  /// Keeps the last frame until a key, or a signal, ends it.
  void hold();

 private:
  int key(int wait_ms) const;

  std::string title_;
  Player player_;
  bool is_open_ = true;
  bool has_size_ = false;  ///< of the first sheet
};

}  // namespace lcs::tools
