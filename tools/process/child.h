/// \file
/// Starts a child process with its own standard files. It does not outlive this process.
#pragma once

#include <sys/types.h>

#include <span>
#include <string>

namespace lcs::process {

/// File descriptors for the child's standard files.
struct StandardFiles {
  int in = -1, out = -1, err = -1;  ///< below 0: /dev/null
};

struct ChildOptions {
  int when_parent_ends = 0;  ///< signal to the child when this process ends
  bool own_group = false;    ///< for Ctrl-C not to reach it, and to end all its children
};

/// \param program path; if it cannot be run, the child exits with 127, as in a shell.
/// \param arguments argv, with the program's name first.
/// \return the child's process id. \throws std::system_error
pid_t start_child(const char* program, std::span<const std::string> arguments,
                  const StandardFiles& files, const ChildOptions& options);

}  // namespace lcs::process
