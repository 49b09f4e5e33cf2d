#include "tools/lcs/interrupt.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>

#include "tools/files/output_file.h"
#include "tools/lcs/exit_codes.h"

namespace lcs::tools {
namespace {

// Longer than the largest picture takes to draw, and than it takes to tidy up. Results that are
// being put in place meanwhile survive SIGKILL, too.
constexpr unsigned kGrace_s = 20;

volatile std::sig_atomic_t requested = 0;

void make_note(int signal) {
  const bool is_first = requested == 0;
  requested = signal;
  if (is_first && signal != SIGPIPE && signal != SIGXFSZ) ::alarm(kGrace_s);
}

/// Of a wait that nothing ends: the handlers of signals let it go on.
void give_up(int) {
  constexpr std::string_view kText = "lcs: interrupted\n";
  pollfd err{STDERR_FILENO, POLLOUT, 0};
  const bool is_read = ::poll(&err, 1, 0) == 1;  // else it would be waited for, too
  if (is_read && ::write(STDERR_FILENO, kText.data(), kText.size()) < 0) ::_exit(kError);
  ::_exit(kInterrupted);
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
  action.sa_handler = give_up;
  sigaction(SIGALRM, &action, nullptr);
}

/// Run by the loader before the initialisers of all libraries, which take tens of milliseconds.
[[gnu::section(".preinit_array"), gnu::used]] void (*const catch_signals_first)() = catch_signals;

}  // namespace

bool is_interrupted() {
  return requested != 0;
}

void check_interrupted() {
  if (requested == SIGXFSZ) bench::fail_to("write", "a file", EFBIG);
  if (requested == SIGPIPE) bench::fail_to("write", "the output", EPIPE);
  if (requested) throw Interrupted();
}

}  // namespace lcs::tools
