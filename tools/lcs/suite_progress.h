/// \file
/// How far a suite is, on stderr: a line a finished run, and on a terminal one that changes.
#pragma once

#include <chrono>
#include <string>

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

  /// What watches from now on, before the names of its runs; "" says nothing of it.
  void watched_by(const std::string& detector) { detector_ = detector; }

  void finished(const suite::SuiteProgress& progress, const suite::ScenarioResult& scenario,
                const suite::RunResult& run);
  void show(const suite::SuiteProgress& progress);
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool is_terminal_;
  bool is_shown_ = false;
  std::string detector_;
  Clock::time_point shown_{};
};

}  // namespace lcs::tools
