#include "tools/process/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <vector>

namespace lcs::process {
namespace {

constexpr int kCannotStart = 127;  // like a shell

/// Runs in the child, up to and including exec; async-signal-safe.
[[noreturn]] void become(const char* program, char* const* arguments, const StandardFiles& files,
                         const ChildOptions& options, pid_t parent) {
  if (options.own_group) ::setpgid(0, 0);
  // Ends the child when the parent ends for any reason.
  if (::prctl(PR_SET_PDEATHSIG, options.when_parent_ends) != 0 || ::getppid() != parent) {
    ::_exit(kCannotStart);
  }
  const auto plug = [](int file, int standard) {
    if (file < 0) file = ::open("/dev/null", O_RDWR);
    return ::dup2(file, standard) >= 0;
  };
  if (plug(files.in, STDIN_FILENO) && plug(files.out, STDOUT_FILENO) &&
      plug(files.err, STDERR_FILENO)) {
    ::execv(program, arguments);
  }
  ::_exit(kCannotStart);
}

}  // namespace

pid_t start_child(const char* program, std::span<const std::string> arguments,
                  const StandardFiles& files, const ChildOptions& options) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  const pid_t self = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become(program, pointers.data(), files, options, self);
  if (child < 0) throw std::system_error(errno, std::generic_category(), "no process can be started (fork)");
  if (options.own_group) ::setpgid(child, child);  // set in both processes, to avoid a race
  return child;
}

}  // namespace lcs::process
