/// \file
/// How far a run is, on stderr: a bar on a terminal, a line every quarter elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace lcs::tools {

class Progress {
 public:
  /// \param total of what is to be done, counted in `unit`.
  /// \param quiet says nothing at all.
  Progress(std::string name, int total, bool quiet, std::string unit = "frames");
  /// Wipes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// \param done so far.
  void show(int done);

 private:
  void show_bar(int done);
  void show_line(int done);

  using Clock = std::chrono::steady_clock;
  std::string name_;
  int total_;
  std::string unit_;
  int told_ = 0;
  enum class Style { none, bar, lines } style_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_{};
};

}  // namespace lcs::tools
