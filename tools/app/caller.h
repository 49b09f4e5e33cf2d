/// \file
/// What the functions of this library tell their caller while they work, and ask of it.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/suite/suite_run.h"

namespace lcs::app {

/// The user has ended the work.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(const std::string& what = "interrupted; nothing was written")
      : std::runtime_error(what) {}
};

/// The progress of a piece of work, until it is destroyed.
class Progress {
 public:
  virtual ~Progress() = default;
  /// \param done number of units that are processed.
  virtual void show([[maybe_unused]] int done) {}
};

/// The defaults do nothing.
class Caller {
 public:
  virtual ~Caller() = default;
  /// Called between two frames or runs. It may throw, Interrupted or another exception, to end the
  /// work: then the function writes nothing, except where its documentation says otherwise.
  virtual void check() {}
  /// A message, such as a missed criterion.
  virtual void tell(const std::string& /*line*/) {}
  /// A message of little weight, which a quiet program leaves out.
  virtual void note(const std::string& /*line*/) {}
  virtual void warn(const std::vector<std::string>& /*lines*/) {}
  /// \param total number of units to process. \param unit its plural, such as "frames".
  virtual std::unique_ptr<Progress> progress([[maybe_unused]] const std::string& name,
                                             [[maybe_unused]] int total,
                                             [[maybe_unused]] const std::string& unit) {
    return std::make_unique<Progress>();
  }

  /// \name Of a suite while it runs.
  ///@{
  /// \param detectors names, the suite's own first. \param runs the result of each detector.
  virtual void finished(const suite::SuiteProgress& /*progress*/, const std::string& /*scenario*/,
                        const std::vector<std::string>& /*detectors*/,
                        std::span<const suite::RunResult* const> /*runs*/) {}
  virtual void show(const suite::SuiteProgress& /*progress*/) {}
  /// Removes the displayed progress.
  virtual void wipe() {}
  ///@}
};

}  // namespace lcs::app
