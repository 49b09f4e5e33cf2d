/// \file
/// Signals as requests that are honoured between two frames, so that nothing is left half done.
#pragma once

#include <stdexcept>

namespace lcs::tools {

class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(const char* what = "interrupted; nothing was written")
      : std::runtime_error(what) {}
};

/// Whether a signal has come that `check_interrupted` throws for.
bool is_interrupted();

/// To be called between two frames. Signals only make a note; but a process that has still not ended
/// 20 s after one that asks it to end, ends at once, whatever it waits for, as by SIGKILL.
/// \throws Interrupted if SIGINT, SIGTERM, SIGHUP or SIGXCPU has come since the program started,
///   bench::OutputError if SIGPIPE or SIGXFSZ has: something could not be written.
void check_interrupted();

}  // namespace lcs::tools
