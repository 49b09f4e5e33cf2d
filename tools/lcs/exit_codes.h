/// \file
/// What the command tells its caller.
#pragma once

namespace lcs::tools {

enum ExitCode : int {
  kFine = 0,
  kCriterionFailed = 1,  ///< the run is whole, but not what the scenario asks for
  kRegressed = 1,        ///< of two suites, the second is worse
  kError = 2,            ///< one message on stderr says what, where, and what to do
  kInterrupted = 130,    ///< by a signal that asks to end, as shells have it
};

}  // namespace lcs::tools
