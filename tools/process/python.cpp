#include "tools/process/python.h"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "tools/process/child.h"

namespace lcs::process {
namespace {

/// A file in memory that a child writes.
class MemoryFile {
 public:
  MemoryFile() : file_(::memfd_create("lcs-python", MFD_CLOEXEC)) {
    if (file_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  }
  ~MemoryFile() { ::close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return file_; }
  std::string text() const {
    std::string text;
    std::array<char, 4096> piece{};
    ::lseek(file_, 0, SEEK_SET);
    for (ssize_t n = 0; (n = ::read(file_, piece.data(), piece.size())) > 0;) {
      text.append(piece.data(), static_cast<std::size_t>(n));
    }
    return text;
  }

 private:
  int file_;
};

}  // namespace

PythonEnd run_python(const std::filesystem::path& script, std::span<const std::string> arguments,
                     int out) {
  const char* python = std::getenv("LCS_PYTHON");
  std::vector<std::string> words{"env", python ? python : "python3", script.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const MemoryFile said, wrong;
  const pid_t child = start_child(
      "/usr/bin/env", words, {.out = out < 0 ? said.descriptor() : out, .err = wrong.descriptor()},
      {.when_parent_ends = SIGTERM});
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, said.text(), wrong.text()};
}

}  // namespace lcs::process
