#include "tools/lcs/interrupt.h"

#include <fmt/format.h>

#include <csignal>
#include <system_error>

#include "tools/files/output_file.h"

namespace lcs::tools {
namespace {

volatile std::sig_atomic_t requested = 0;

void make_note(int signal) {
  requested = signal;
}

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = make_note;
  action.sa_flags = SA_RESTART;  // files being written are not to be disturbed
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGPIPE, SIGXFSZ}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    const bool is_nohup = signal == SIGHUP && before.sa_handler == SIG_IGN;
    if (!is_nohup) sigaction(signal, &action, nullptr);
  }
}

/// Run by the loader before the initialisers of all libraries, which take tens of milliseconds.
[[gnu::section(".preinit_array"), gnu::used]] void (*const catch_signals_first)() = catch_signals;

}  // namespace

void check_interrupted() {
  const auto fail = [](const char* what, std::errc why) {
    const std::error_code error = std::make_error_code(why);
    throw bench::OutputError(
        fmt::format("cannot write {}: {}; {}", what, error.message(), bench::remedy(error)));
  };
  if (requested == SIGXFSZ) fail("a file", std::errc::file_too_large);
  if (requested == SIGPIPE) fail("what there is to tell", std::errc::broken_pipe);
  if (requested) throw Interrupted();
}

}  // namespace lcs::tools
