#include "tools/lcs/interrupt.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>

#include "tools/files/output_file.h"
#include "tools/lcs/command_line.h"

namespace lcs::tools {
namespace {

// Longer than rendering the largest picture or cleaning up takes. Results that are being committed
// when it expires survive, as they survive SIGKILL.
constexpr unsigned kGrace_s = 20;

volatile std::sig_atomic_t requested = 0;

void make_note(int signal) {
  const bool is_first = requested == 0;
  requested = signal;
  if (is_first && signal != SIGPIPE && signal != SIGXFSZ) ::alarm(kGrace_s);
}

/// Handler of SIGALRM. Ends a process whose blocking call resumes after signals (SA_RESTART).
void give_up(int) {
  constexpr std::string_view kText = "lcs: interrupted\n";
  pollfd err{STDERR_FILENO, POLLOUT, 0};
  const bool is_read = ::poll(&err, 1, 0) == 1;  // otherwise the write could block, too
  if (is_read && ::write(STDERR_FILENO, kText.data(), kText.size()) < 0) ::_exit(kError);
  ::_exit(kInterrupted);
}

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = make_note;
  action.sa_flags = SA_RESTART;  // signals must not interrupt file writes
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGPIPE, SIGXFSZ}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    const bool is_nohup = signal == SIGHUP && before.sa_handler == SIG_IGN;
    if (!is_nohup) sigaction(signal, &action, nullptr);
  }
  action.sa_handler = give_up;
  sigaction(SIGALRM, &action, nullptr);
}

/// The loader runs this before the libraries' initialisers, which take tens of milliseconds.
[[gnu::section(".preinit_array"), gnu::used]] void (*const catch_signals_first)() = catch_signals;

}  // namespace

bool is_interrupted() {
  return requested != 0;
}

void check_interrupted() {
  if (requested == SIGXFSZ) files::fail_to("write", "a file", EFBIG);
  if (requested == SIGPIPE) files::fail_to("write", "the output", EPIPE);
  if (requested) throw Interrupted();
}

}  // namespace lcs::tools
