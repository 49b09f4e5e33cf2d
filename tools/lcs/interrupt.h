/// \file
/// Termination signals are handled between two frames, so that no output is left incomplete.
#pragma once

#include "tools/app/caller.h"

namespace lcs::tools {

using app::Interrupted;

/// Whether a signal has arrived for which `check_interrupted` throws.
bool is_interrupted();

/// To be called between two frames. A signal handler only records the signal. If the process still
/// runs 20 s after a termination signal, it exits at once without cleanup.
/// \throws Interrupted if SIGINT, SIGTERM, SIGHUP or SIGXCPU has arrived since the program started;
///   files::OutputError if SIGPIPE or SIGXFSZ has arrived: a write failed.
void check_interrupted();

}  // namespace lcs::tools
