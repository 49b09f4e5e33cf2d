#include "tools/lcs/terminal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <system_error>

#include "scenarios/message.h"
#include "tools/files/output_file.h"

namespace lcs::tools {
namespace {

[[noreturn]] void fail(int error) {
  const std::error_code code(error, std::generic_category());
  throw bench::OutputError(
      fmt::format("cannot write to standard output: {}; {}", code.message(), bench::remedy(code)));
}

}  // namespace

void open_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // the lowest that is free is taken, which is this one
    if (::fcntl(descriptor, F_GETFD) < 0) ::open("/dev/null", O_RDWR);
  }
}

void write_out(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) fail(errno);
}

void write_err(const std::string& text) {
  std::fflush(stdout);  // in a file that both go to, what came first stands first
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void tell(std::string_view message) {
  write_err(scenario::one_line(message) + '\n');
}

void warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) tell("warning: " + line);
}

void finish_out() {
  std::cout.flush();
  const bool has_failed = std::ferror(stdout) != 0;  // what was to be written then is lost
  if (std::fflush(stdout) != 0 || has_failed) fail(errno);
}

}  // namespace lcs::tools
