/// \file
/// How far a suite is, on stderr: a line a finished run, and on a terminal one that changes.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "tools/suite/suite_run.h"

namespace lcs::tools {

class SuiteProgress {
 public:
  /// \param quiet says nothing at all.
  explicit SuiteProgress(bool quiet);
  /// Wipes the line.
  ~SuiteProgress();
  SuiteProgress(const SuiteProgress&) = delete;
  SuiteProgress& operator=(const SuiteProgress&) = delete;

  /// \param detectors that watched, the suite's own first. \param runs what it came to for each.
  void finished(const suite::SuiteProgress& progress, const std::string& scenario,
                const std::vector<std::string>& detectors,
                std::span<const suite::RunResult* const> runs);
  void show(const suite::SuiteProgress& progress);
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool is_terminal_;
  bool is_shown_ = false;
  Clock::time_point shown_{};
};

}  // namespace lcs::tools
