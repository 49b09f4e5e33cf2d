/// \file
/// How far a run is, on stderr: a bar on a terminal, a line every quarter elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace lcs::tools {

class Progress {
 public:
  /// \param quiet says nothing at all.
  Progress(std::string name, int frames, bool quiet);
  /// Wipes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// \param done frames so far.
  void show(int done);

 private:
  void show_bar(int done);
  void show_line(int done);

  using Clock = std::chrono::steady_clock;
  std::string name_;
  int frames_;
  enum class Style { none, bar, lines } style_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_{};
};

}  // namespace lcs::tools
