#include "tools/process/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace lcs::process {
namespace {

constexpr int kCannotStart = 127;  // like a shell

struct Start {
  const char* program;
  char* const* arguments;
  const StandardFiles& files;
  const ChildOptions& options;
  sigset_t blocked;  ///< signals, of the thread that asks
};

/// Runs in the child, up to and including exec; async-signal-safe.
[[noreturn]] void become(const Start& start, pid_t parent) {
  if (start.options.own_group) ::setpgid(0, 0);
  // Ends the child when the parent ends for any reason.
  if (::prctl(PR_SET_PDEATHSIG, start.options.when_parent_ends) != 0 || ::getppid() != parent) {
    ::_exit(kCannotStart);
  }
  if (const int lifeline = start.options.lifeline; lifeline >= 0) {
    ::fcntl(lifeline, F_SETSIG, SIGKILL);
    ::fcntl(lifeline, F_SETOWN, -::getpid());
    ::fcntl(lifeline, F_SETFL, O_ASYNC);
    ::fcntl(lifeline, F_SETFD, 0);  // inherited by the program
  }
  const auto plug = [](int file, int standard) {
    if (file < 0) file = ::open("/dev/null", O_RDWR);
    return ::dup2(file, standard) >= 0;
  };
  if (plug(start.files.in, STDIN_FILENO) && plug(start.files.out, STDOUT_FILENO) &&
      plug(start.files.err, STDERR_FILENO)) {
    ::pthread_sigmask(SIG_SETMASK, &start.blocked, nullptr);
    ::execv(start.program, start.arguments);
  }
  ::_exit(kCannotStart);
}

/// A thread that starts all children and lives as long as the process: the kernel ends a child with
/// the thread that started it, and not with the process (PR_SET_PDEATHSIG).
class Starter {
 public:
  /// Is never destroyed, as its thread has no end.
  static Starter& of_this_process() {
    static std::atomic<Starter*> known;
    Starter* starter = known;
    // A fork has no thread but the one that forked. The thread of a starter that comes too late
    // sleeps forever.
    while (!starter || starter->process_ != ::getpid()) {
      auto* own = new Starter;
      if (known.compare_exchange_strong(starter, own)) return *own;
    }
    return *starter;
  }

  pid_t start(const Start& start) {
    const std::lock_guard one_at_a_time(asking_);
    std::unique_lock lock(mutex_);
    start_ = &start;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !start_; });
    if (child_ < 0) {
      throw std::system_error(error_, std::generic_category(), "no process can be started (fork)");
    }
    return child_;
  }

 private:
  Starter() {
    // Signals are for the other threads.
    sigset_t all, before;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    try {
      std::thread([this] { serve(); }).detach();
    } catch (...) {
      ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
      throw;
    }
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  [[noreturn]] void serve() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return start_; });
      child_ = ::fork();
      if (child_ == 0) become(*start_, process_);
      error_ = errno;
      start_ = nullptr;
      changed_.notify_all();
    }
  }

  const pid_t process_ = ::getpid();
  std::mutex asking_, mutex_;
  std::condition_variable changed_;
  const Start* start_ = nullptr;  ///< null once it is done
  pid_t child_ = -1;
  int error_ = 0;
};

}  // namespace

MemoryFile::MemoryFile(const char* problem) : file_(::memfd_create("lcs", MFD_CLOEXEC)) {
  if (!file_.is_open()) throw std::system_error(errno, std::generic_category(), problem);
}

std::string MemoryFile::text(std::size_t most) const {
  struct stat status = {};
  if (::fstat(file_.get(), &status) != 0) return "";
  std::string text(std::min(static_cast<std::size_t>(status.st_size), most), '\0');
  const off_t begin = status.st_size - static_cast<off_t>(text.size());
  const ssize_t got = ::pread(file_.get(), text.data(), text.size(), begin);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return text;
}

pid_t start_child(const char* program, std::span<const std::string> arguments,
                  const StandardFiles& files, const ChildOptions& options) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  Start start{program, pointers.data(), files, options, {}};
  ::pthread_sigmask(SIG_SETMASK, nullptr, &start.blocked);
  const pid_t child = Starter::of_this_process().start(start);
  if (options.own_group) ::setpgid(child, child);  // set in both processes, to avoid a race
  return child;
}

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
