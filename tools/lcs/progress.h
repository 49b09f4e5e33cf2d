/// \file
/// Progress of a run on stderr: a bar on a terminal, otherwise a line at every quarter.
#pragma once

#include <chrono>
#include <string>

#include "tools/app/caller.h"

namespace lcs::tools {

class ConsoleProgress : public app::Progress {
 public:
  /// \param total number of `unit`s to process.
  /// \param quiet prints nothing.
  ConsoleProgress(std::string name, int total, bool quiet, std::string unit = "frames");
  /// Erases the bar.
  ~ConsoleProgress() override;
  ConsoleProgress(const ConsoleProgress&) = delete;
  ConsoleProgress& operator=(const ConsoleProgress&) = delete;

  void show(int done) override;

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
