/// \file
/// A program that is started with standard files of its own and does not outlive this one.
#pragma once

#include <sys/types.h>

#include <span>
#include <string>

namespace lcs::process {

/// Descriptors that become the child's.
struct StandardFiles {
  int in = -1, out = -1, err = -1;  ///< below 0: /dev/null
};

struct ChildOptions {
  int when_parent_ends = 0;  ///< signal that the child gets when the thread ends that started it
  bool own_group = false;    ///< so that Ctrl-C does not reach it, and it is ended with its own
};

/// \param program its path; where it cannot be run, the child exits with 127, as in a shell.
/// \param arguments the name that it is called by, and what follows it.
/// \return the child's id. \throws std::system_error
pid_t start_child(const char* program, std::span<const std::string> arguments,
                  const StandardFiles& files, const ChildOptions& options);

}  // namespace lcs::process
