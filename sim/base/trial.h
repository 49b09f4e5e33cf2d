/// \file
/// Runs code that may crash in a child process, so that the program survives the crash.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace lcs::sim {

/// How the child ended.
struct [[nodiscard]] Trial {
  bool fine = false;    ///< the action returned
  std::string refused;  ///< message of the exception that it threw, or empty
  /// The signal or limit that ended it, or "": "signal SEGV", "10 s of processor time", "memory".
  std::string crash;
};

/// Limits of a trial. The largest useful scenes load in a tenth of these; the wall time leaves room
/// for busy machines.
struct TrialBounds {
  unsigned processor_s = 10;
  unsigned wall_s = 30;
  std::size_t more_memory = std::size_t{4} << 30;  ///< bytes, in addition to the memory in use
};

/// Runs `action` in a fork of this process. Its output to stdout and stderr is dropped; it has no
/// input, leaves no core, and ends when this process ends.
///
/// The child has only the calling thread. `action` must not wait for a lock that another thread may
/// hold, nor use GL after this process has used it: Mesa's threads do not exist in the child.
/// \throws std::system_error if no child can be started.
Trial try_in_child(const std::function<void()>& action, const TrialBounds& bounds = {});

}  // namespace lcs::sim
