/// \file
/// Signals as requests that are honoured between two frames, so that nothing is left half done.
#pragma once

#include <stdexcept>

namespace lcs::tools {

class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// To be called between two frames. Signals only make a note.
/// \throws Interrupted if SIGINT, SIGTERM, SIGHUP or SIGXCPU has come since the program started,
///   bench::OutputError if SIGPIPE or SIGXFSZ has: something could not be written.
void check_interrupted();

}  // namespace lcs::tools
