/// \file
/// Exit codes of the `lcs` command.
#pragma once

namespace lcs::tools {

enum ExitCode : int {
  kFine = 0,
  kCriterionFailed = 1,  ///< the run completed but missed a required criterion
  kRegressed = 1,        ///< the second of two suites is worse
  kError = 2,            ///< stderr has one message: the error, its place and the remedy
  kInterrupted = 130,    ///< by a termination signal; 128 + SIGINT, as shells report it
};

}  // namespace lcs::tools
