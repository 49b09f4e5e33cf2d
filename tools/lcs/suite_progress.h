/// \file
/// Progress of a suite on stderr: a line per finished run, and on a terminal a status line.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "tools/app/suite.h"

namespace lcs::tools {

class ConsoleSuiteProgress : public app::SuiteWatch {
 public:
  /// \param quiet prints nothing.
  explicit ConsoleSuiteProgress(bool quiet);
  /// Erases the status line.
  ~ConsoleSuiteProgress() override;
  ConsoleSuiteProgress(const ConsoleSuiteProgress&) = delete;
  ConsoleSuiteProgress& operator=(const ConsoleSuiteProgress&) = delete;

  void finished(const suite::SuiteProgress& progress, const std::string& scenario,
                const std::vector<std::string>& detectors,
                std::span<const suite::RunResult* const> runs) override;
  void show(const suite::SuiteProgress& progress) override;
  void wipe() override;

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool is_terminal_;
  bool is_shown_ = false;
  Clock::time_point shown_{};
};

}  // namespace lcs::tools
