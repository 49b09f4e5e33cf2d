/// \file
/// Tries in a child process what may crash a library, so that the program survives the crash.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace lcs::sim {

/// How the child's try ended.
struct Trial {
  bool fine = false;    ///< it returned
  std::string refused;  ///< what it threw, if it threw
  /// How it ended otherwise: "signal SEGV", "10 s of processor time", "memory"; else empty.
  std::string crash;
};

/// What a try may take at most. The largest scenes that are of use load in a tenth of that; the
/// wall time leaves room for busy machines.
struct TrialBounds {
  unsigned processor_s = 10;
  unsigned wall_s = 30;
  std::size_t more_memory = std::size_t{4} << 30;  ///< bytes, beyond what is in use
};

/// Runs `action` in a fork of this process. What it writes to stdout and stderr is dropped; it has
/// no input, leaves no core, and ends when this process ends.
///
/// The child has only the calling thread: `action` must wait for no lock that another thread may
/// hold, and use no GL where this process has used it: Mesa's threads are not the child's.
/// \throws std::system_error if no child can be started.
Trial try_in_child(const std::function<void()>& action, const TrialBounds& bounds = {});

}  // namespace lcs::sim
