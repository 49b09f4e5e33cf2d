/// \file
/// Starts a child process with its own standard files, and by Python a script that ships with the
/// program. It does not outlive this process.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <span>
#include <string>

#include "scenarios/input/descriptor.h"

namespace lcs::process {

/// File descriptors for the child's standard files.
struct StandardFiles {
  int in = -1, out = -1, err = -1;  ///< below 0: /dev/null
};

/// A file in memory that a child writes.
class MemoryFile {
 public:
  /// \param problem what to say if none can be made. \throws std::system_error
  explicit MemoryFile(const char* problem);

  int descriptor() const { return file_.get(); }
  /// Its last bytes; "" if they cannot be read.
  std::string text(std::size_t most = std::numeric_limits<std::size_t>::max()) const;

 private:
  input::Descriptor file_;
};

struct ChildOptions {
  int when_parent_ends = 0;  ///< signal to the child when this process ends
  bool own_group = false;    ///< for Ctrl-C not to reach it, and to end all its children
  /// The read end of a pipe, or -1. The kernel kills the child's own group when the pipe's last
  /// writer is gone. Set before the child's program runs, so that no moment is without it.
  int lifeline = -1;
};

/// \param program path; if it cannot be run, the child exits with 127, as in a shell.
/// \param arguments argv, with the program's name first.
/// \return the child's process id. \throws std::system_error
pid_t start_child(const char* program, std::span<const std::string> arguments,
                  const StandardFiles& files, const ChildOptions& options);

struct PythonEnd {
  bool is_fine = false;  ///< it exited with 0
  std::string out, err;  ///< its texts
};

/// Runs a script to its end by the Python that the environment's LCS_PYTHON names, or by python3.
/// \param out a file descriptor for its standard output; below 0: `PythonEnd::out`.
/// \throws std::system_error
PythonEnd run_python(const std::filesystem::path& script, std::span<const std::string> arguments,
                     int out = -1);

}  // namespace lcs::process
