#include "sim/base/trial.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <stdexcept>
#include <system_error>

namespace lcs::sim {
namespace {

/// The child's result, in memory shared with the parent.
struct Report {
  enum class Kind { nothing, fine, refused, no_memory };
  Kind kind = Kind::nothing;
  std::array<char, 4000> text{};
};

[[noreturn]] void fail(const char* call) {
  throw std::system_error(errno, std::generic_category(),
                          std::string("no child process can be started, to try what may crash; end "
                                      "other programs, or raise ulimit -u (") +
                              call + ")");
}

struct Unmap {
  void operator()(Report* report) const { ::munmap(report, sizeof(Report)); }
};
using SharedReport = std::unique_ptr<Report, Unmap>;

SharedReport shared_report() {
  void* memory =
      ::mmap(nullptr, sizeof(Report), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) fail("mmap");
  return SharedReport(new (memory) Report);
}

/// Virtual memory in use, bytes. With a sanitizer it is some terabytes.
rlim_t memory_in_use() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, rlim_t most) {
  struct rlimit now = {};
  if (::getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min(now.rlim_cur, most);
  ::setrlimit(resource, &now);
}

/// In the child: cuts its input and output, and limits its resources.
void isolate(pid_t parent, const TrialBounds& bounds) {
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || ::getppid() != parent) ::_exit(1);
  const int null = ::open("/dev/null", O_RDWR);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null, file);
  for (const int fatal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGALRM, SIGXCPU}) {
    ::signal(fatal, SIG_DFL);
  }
  // the parent handles these signals after the child has ended
  for (const int sent : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) ::signal(sent, SIG_IGN);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, bounds.processor_s);
  limit(RLIMIT_AS, memory_in_use() + bounds.more_memory);
  ::alarm(bounds.wall_s);
}

void run(const std::function<void()>& action, Report& report) {
  const auto say = [&](Report::Kind kind, const char* text) {
    std::strncpy(report.text.data(), text, report.text.size() - 1);
    report.kind = kind;
  };
  try {
    action();
    say(Report::Kind::fine, "");
  } catch (const std::bad_alloc&) {
    say(Report::Kind::no_memory, "");
  } catch (const std::length_error&) {  // a container larger than the address space
    say(Report::Kind::no_memory, "");
  } catch (const std::exception& e) {
    say(Report::Kind::refused, e.what());
  }
}

std::string crash_of(int status, const TrialBounds& bounds) {
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == 0) return "exit code " + std::to_string(WEXITSTATUS(status));
  if (signal == SIGXCPU) return std::to_string(bounds.processor_s) + " s of processor time";
  if (signal == SIGALRM) return std::to_string(bounds.wall_s) + " s";
  // from the kernel's out-of-memory killer; nobody else knows the child
  if (signal == SIGKILL) return "memory";
  const char* name = ::sigabbrev_np(signal);
  return std::string("signal ") + (name ? name : std::to_string(signal));
}

}  // namespace

Trial try_in_child(const std::function<void()>& action, const TrialBounds& bounds) {
  const SharedReport report = shared_report();
  const pid_t self = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    isolate(self, bounds);
    run(action, *report);
    ::_exit(0);  // without flushing buffers or running destructors, which belong to the parent
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  Trial trial;
  trial.fine = report->kind == Report::Kind::fine;
  if (report->kind == Report::Kind::refused) trial.refused = report->text.data();
  if (report->kind == Report::Kind::no_memory) trial.crash = "memory";
  if (report->kind == Report::Kind::nothing) trial.crash = crash_of(status, bounds);
  return trial;
}

}  // namespace lcs::sim
