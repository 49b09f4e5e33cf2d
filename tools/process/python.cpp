#include "tools/process/python.h"

#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <vector>

#include "tools/process/child.h"

namespace lcs::process {

PythonEnd run_python(const std::filesystem::path& script, std::span<const std::string> arguments,
                     int out) {
  const char* python = std::getenv("LCS_PYTHON");
  std::vector<std::string> words{"env", python ? python : "python3", script.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const MemoryFile said("memfd_create"), wrong("memfd_create");
  const pid_t child = start_child(
      "/usr/bin/env", words, {.out = out < 0 ? said.descriptor() : out, .err = wrong.descriptor()},
      {.when_parent_ends = SIGTERM});
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, said.text(), wrong.text()};
}

}  // namespace lcs::process
