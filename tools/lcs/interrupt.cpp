#include "tools/lcs/interrupt.h"

namespace lcs::tools {
namespace {

volatile std::sig_atomic_t requested = 0;

void make_note(int) {
  requested = 1;
}

}  // namespace

InterruptGuard::InterruptGuard() {
  requested = 0;
  struct sigaction action = {};
  action.sa_handler = make_note;
  action.sa_flags = SA_RESTART;  // files being written are not to be disturbed
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &old_int_);
  sigaction(SIGTERM, &action, &old_term_);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &old_int_, nullptr);
  sigaction(SIGTERM, &old_term_, nullptr);
}

void InterruptGuard::check() const {
  if (requested) throw Interrupted();
}

}  // namespace lcs::tools
