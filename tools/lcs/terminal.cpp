#include "tools/lcs/terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <stdio_ext.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <mutex>

#include "scenarios/input/message.h"
#include "scenarios/shipped.h"
#include "sim/pictures/picture_file.h"
#include "tools/files/output_file.h"
#include "tools/lcs/interrupt.h"

namespace lcs::tools {
namespace {

/// Waits until a block can be written. A write to a pipe that nobody reads would block forever,
/// even across signals. \return false if a termination signal arrived first.
bool has_room(int descriptor) {
  constexpr int kTick_ms = 1000;
  while (true) {
    pollfd one{descriptor, POLLOUT, 0};
    const bool is_last = is_interrupted();
    const int ready = ::poll(&one, 1, is_last ? 0 : kTick_ms);
    if (ready > 0 || (ready < 0 && errno != EINTR)) return true;  // the write reports the error
    if (is_last) return false;
  }
}

/// \return whether all of it was written.
bool write(std::FILE* file, std::string_view text) {
  constexpr std::size_t kBlock = PIPE_BUF;  // a pipe with room accepts this many bytes at once
  for (; !text.empty(); text.remove_prefix(std::min(kBlock, text.size()))) {
    if (!has_room(::fileno(file))) return false;
    const std::string_view block = text.substr(0, kBlock);
    if (std::fwrite(block.data(), 1, block.size(), file) != block.size()) return false;
  }
  return true;
}

/// Flushes stdout, or discards its buffer after a signal. \return whether it was written.
bool flush_out() {
  if (::__fpending(stdout) == 0 || has_room(STDOUT_FILENO)) return std::fflush(stdout) == 0;
  ::__fpurge(stdout);  // otherwise exit would block on it
  return false;
}

[[noreturn]] void fail_out() {
  if (std::ferror(stdout) == 0) throw Interrupted("interrupted before all was told");
  files::fail_to("write to", "standard output", errno);
}

}  // namespace

void open_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // open() returns the lowest free descriptor, which is this one
    if (::fcntl(descriptor, F_GETFD) < 0) ::open("/dev/null", O_RDWR);
  }
}

void write_out(const std::string& text) {
  if (!write(stdout, text)) fail_out();
}

void write_err(const std::string& text) {
  flush_out();  // keeps the order if stdout and stderr are one file
  const std::lock_guard lock(sim::stderr_mutex());
  write(stderr, text);
}

void tell(std::string_view message) {
  write_err(input::one_line(message) + '\n');
}

std::filesystem::path scenario_file(const std::string& named) {
  const auto shipped = scenario::shipped_scenario(named);
  if (shipped) tell(named + " is " + shipped->string());
  return shipped.value_or(named);
}

void warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) tell("warning: " + line);
}

std::string coloured(const std::string& text, suite::Light light) {
  constexpr std::array<int, 3> kCodes{31, 33, 32};  // red, yellow, green
  const auto is = [](const char* variable, auto&& test) {
    const char* value = std::getenv(variable);
    return value != nullptr && test(std::string_view(value));
  };
  const bool is_plain = ::isatty(STDOUT_FILENO) == 0 ||
                        is("NO_COLOR", [](auto value) { return !value.empty(); }) ||
                        is("TERM", [](auto value) { return value == "dumb"; });
  return is_plain
             ? text
             : fmt::format("\x1b[{}m{}\x1b[0m", kCodes.at(static_cast<std::size_t>(light)), text);
}

void Terminal::check() {
  check_interrupted();
}

void Terminal::note(const std::string& line) {
  if (!quiet_) tools::tell(line);
}

void finish_out() {
  std::cout.flush();
  const bool has_failed = std::ferror(stdout) != 0;  // an earlier write failed
  if (!flush_out() || has_failed) fail_out();
}

}  // namespace lcs::tools
