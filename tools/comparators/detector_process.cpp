#include "tools/comparators/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <thread>

#include "tools/files/csv.h"
#include "tools/process/child.h"

namespace lcs::comparators {
namespace {

using namespace std::chrono_literals;
using input::Descriptor;

constexpr auto kTick = 50ms;        // between calls of on_wait
constexpr auto kPatience = 2s;      // for a process to exit after a request
constexpr auto kLastWords = 500ms;  // for the last output of a process that exits
constexpr std::size_t kMostStderr = 1U << 16U;
constexpr std::ptrdiff_t kMostLines = 8;  // of stderr in messages

[[noreturn]] void fail_to_connect() {
  throw std::system_error(errno, std::generic_category(), "no pipe to the detector can be made");
}

/// Prefixes a single command with `exec`, so that it replaces the shell: closing its files and its
/// death by a signal then become visible directly.
std::string for_shell(const std::string& command) {
  const bool is_list = command.find_first_of(";&|(){}<>\n!") != std::string::npos;
  const std::string first = command.substr(0, command.find(' '));
  return is_list || first.find('=') != std::string::npos ? command : "exec " + command;
}

/// Blocks SIGPIPE: writing to an ended program then fails with an error. The signal remains in use
/// for this program's own output.
class [[nodiscard]] WithoutPipeSignal {
 public:
  WithoutPipeSignal() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~WithoutPipeSignal() {
    const int error = errno;
    constexpr timespec kNow{};
    if (!was_pending_) {
      while (sigtimedwait(&pipe_, nullptr, &kNow) < 0 && errno == EINTR) {
      }
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    errno = error;
  }
  WithoutPipeSignal(const WithoutPipeSignal&) = delete;
  WithoutPipeSignal& operator=(const WithoutPipeSignal&) = delete;

 private:
  sigset_t pipe_{}, before_{};
  bool was_pending_ = false;
};

/// The beginning of an unexpected answer.
std::string beginning_of(const std::string& text) {
  constexpr std::size_t kMost = 60;
  return fmt::format("'{}'{}", text.substr(0, std::min(text.find('\n'), kMost)),
                     text.size() > kMost ? "..." : "");
}

}  // namespace

DetectorProcess::DetectorProcess(const std::string& command, double timeout_s,
                                 std::function<void()> on_wait)
    : timeout_s_(timeout_s), on_wait_(std::move(on_wait)) {
  Descriptor its_in, its_out, its_err, its_lifeline;
  const auto connect = [](Descriptor& reads, Descriptor& writes) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_connect();
    reads = Descriptor(ends[0]);
    writes = Descriptor(ends[1]);
  };
  connect(its_in, in_);
  connect(out_, its_out);
  connect(err_, its_err);
  connect(its_lifeline, lifeline_);
  for (const Descriptor* own : {&in_, &out_, &err_}) {
    if (::fcntl(own->get(), F_SETFL, O_NONBLOCK) != 0) fail_to_connect();
  }
  ::fcntl(in_.get(), F_SETPIPE_SZ, 1 << 20);  // speeds up pictures; may fail

  const std::array<std::string, 3> shell{"sh", "-c", for_shell(command)};
  pid_ = process::start_child(
      "/bin/sh", shell, {its_in.get(), its_out.get(), its_err.get()},
      {.when_parent_ends = SIGKILL, .own_group = true, .lifeline = its_lifeline.get()});
}

DetectorProcess::~DetectorProcess() {
  in_.close();
  if (status_) return;
  if (!has_ended()) ::kill(-pid_, SIGTERM);
  const Clock::time_point deadline = Clock::now() + kPatience;
  while (!has_ended() && Clock::now() < deadline) {
    // drains its output, so that a full pipe does not block it
    std::array<char, 4096> rest{};
    for (const Descriptor* pipe : {&out_, &err_}) {
      while (pipe->is_open() && ::read(pipe->get(), rest.data(), rest.size()) > 0) {
      }
    }
    std::this_thread::sleep_for(5ms);
  }
  reap();
}

std::string DetectorProcess::request(std::string_view line, std::span<const unsigned char> bytes) {
  const Clock::time_point deadline = time_is_up();
  read_what_is_there();
  if (!answers_.empty()) {
    throw DetectorError(fmt::format(
        "it wrote {} before this was asked; write one line for each frame, and nothing else",
        beginning_of(answers_)));
  }
  std::string_view picture(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  while (true) {
    if (in_.is_open()) write_some(line, picture);
    std::size_t unread = line.size() + picture.size();
    const bool ended = has_ended();  // if so, all its output is in the pipe
    read_what_is_there();
    const std::size_t end = answers_.find('\n');
    if (std::min(end, answers_.size()) > most_answer_) {
      throw DetectorError(fmt::format(
          "its line is longer than {} bytes; write a shorter one, or say \"{}\" in the greeting",
          most_answer_, kAnswerBytes));
    }
    if (end != std::string::npos) {
      if (int in_pipe = 0; !bytes.empty() && ::ioctl(in_.get(), FIONREAD, &in_pipe) == 0) {
        unread += static_cast<std::size_t>(in_pipe);
      }
      if (unread > 0 && in_.is_open()) {
        throw DetectorError(
            fmt::format("it answered before it had read the last {} bytes of the frame; read the "
                        "line and all bytes of the picture behind it",
                        unread));
      }
      std::string answer = answers_.substr(0, end);
      answers_.erase(0, end + 1);
      return answer;
    }
    if (ended || !out_.is_open() || !in_.is_open()) fail_ended();
    if (Clock::now() >= deadline) {
      throw DetectorError(with_stderr(fmt::format(
          "no answer within {} s; end each answer with a line end and flush it, or give more time "
          "by --detector-timeout",
          timeout_s_)));
    }
    wait(unread > 0, deadline);
  }
}

DetectorProcess::Clock::time_point DetectorProcess::time_is_up() const {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s_));
}

void DetectorProcess::finish() {
  in_.close();
  const Clock::time_point deadline = time_is_up();
  wait_for_end(deadline);
  if (!answers_.empty()) {
    throw DetectorError(fmt::format(
        "it wrote {} after its last answer; write one line for each frame, and nothing else",
        beginning_of(answers_)));
  }
  if (!has_ended()) {
    throw DetectorError(with_stderr(fmt::format(
        "it has not ended within {} s after its input did; end where nothing more is to be read",
        timeout_s_)));
  }
  reap();
  if (*status_ != 0) fail_ended();
}

std::vector<std::string> DetectorProcess::said() const {
  std::vector<std::string_view> lines = files::split(stderr_, '\n');
  std::erase(lines, "");
  return {lines.end() - std::min(std::ssize(lines), kMostLines), lines.end()};
}

/// Waits until a pipe is ready, at most for a tick.
void DetectorProcess::wait(bool to_write, Clock::time_point deadline) const {
  std::array<pollfd, 3> pipes{{{out_.get(), POLLIN, 0},  // poll ignores those < 0
                               {err_.get(), POLLIN, 0},
                               {to_write ? in_.get() : -1, POLLOUT, 0}}};
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  const auto most = std::clamp<std::chrono::milliseconds>(left, 0ms, kTick);
  ::poll(pipes.data(), pipes.size(), static_cast<int>(most.count()));  // a signal ends it, too
  if (on_wait_) on_wait_();
}

void DetectorProcess::read_what_is_there() {
  std::array<char, 65536> some{};
  const auto drain = [&](Descriptor& pipe, std::string& text, std::size_t most) {
    // bounded, in case it writes endlessly
    for (int i = 0; i < 64 && pipe.is_open() && text.size() <= most; ++i) {
      const ssize_t got = ::read(pipe.get(), some.data(), some.size());
      if (got < 0 && errno == EINTR) continue;
      if (got < 0 && errno == EAGAIN) return;
      if (got <= 0) {
        pipe.close();
      } else {
        text.append(some.data(), static_cast<std::size_t>(got));
      }
      if (&text == &stderr_ && text.size() > kMostStderr) text.erase(0, text.size() - kMostStderr);
    }
  };
  drain(out_, answers_, most_answer_);
  drain(err_, stderr_, kMostStderr);
}

void DetectorProcess::write_some(std::string_view& first, std::string_view& second) {
  const WithoutPipeSignal guard;
  for (std::string_view* part : {&first, &second}) {
    while (!part->empty()) {
      const ssize_t written = ::write(in_.get(), part->data(), part->size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0 && errno == EAGAIN) return;
      if (written < 0) {
        in_.close();  // no reader is left
        return;
      }
      part->remove_prefix(static_cast<std::size_t>(written));
    }
  }
}

void DetectorProcess::fail_ended() {
  wait_for_end(Clock::now() + kLastWords);
  if (!has_ended()) {
    throw DetectorError(with_stderr(
        fmt::format("it has closed its {}, and still runs", in_.is_open() ? "output" : "input")));
  }
  reap();
  constexpr int kOfSignal = 128;  // a shell adds the signal's number to it
  const int code = WIFSIGNALED(*status_) ? kOfSignal + WTERMSIG(*status_) : WEXITSTATUS(*status_);
  const bool is_signal = code > kOfSignal && code < kOfSignal + NSIG;
  throw DetectorError(with_stderr(is_signal
                                      ? fmt::format("it was ended by signal {} ({})",
                                                    code - kOfSignal, ::strsignal(code - kOfSignal))
                                      : fmt::format("it ended with exit code {}", code)));
}

/// Waits for the program's exit, and reads its output until then.
void DetectorProcess::wait_for_end(Clock::time_point deadline) {
  while (!has_ended() && Clock::now() < deadline) {
    read_what_is_there();
    wait(false, std::min(deadline, Clock::now() + 5ms));
  }
  read_what_is_there();
}

/// Leaves it unreaped, as its id names the group to end.
bool DetectorProcess::has_ended() const {
  if (status_) return true;
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == pid_;
}

void DetectorProcess::reap() {
  if (status_) return;
  ::kill(-pid_, SIGKILL);  // and its children
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  status_ = status;
}

std::string DetectorProcess::with_stderr(const std::string& what) const {
  const std::vector<std::string> lines = said();
  if (lines.empty()) return what + "; it wrote nothing to stderr";
  return fmt::format("{}; it wrote to stderr: {}", what, fmt::join(lines, " | "));
}

}  // namespace lcs::comparators
