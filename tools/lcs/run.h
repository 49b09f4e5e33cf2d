/// \file
/// The end of a run on the terminal. `lcs run` and `lcs replay` share it.
#pragma once

#include "tools/app/run.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

/// Prints the figures and the missed criteria of a run.
ExitCode show_run(const app::RunMade& made, bool quiet);

}  // namespace lcs::tools
