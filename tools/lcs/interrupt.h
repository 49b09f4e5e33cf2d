/// \file
/// Ctrl-C as a request that is honoured between two frames, so that nothing is left half done.
#pragma once

#include <csignal>
#include <stdexcept>

namespace lcs::tools {

class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// While one lives, SIGINT and SIGTERM only make a note. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// \throws Interrupted if one of them has come.
  void check() const;

 private:
  struct sigaction old_int_, old_term_;
};

}  // namespace lcs::tools
