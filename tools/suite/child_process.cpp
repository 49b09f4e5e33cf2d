#include "tools/suite/child_process.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <cstring>
#include <list>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>

#include "scenarios/shipped.h"
#include "tools/process/child.h"

namespace lcs::suite {
namespace {

using namespace std::chrono_literals;

/// Short against a run, which takes seconds.
constexpr auto kPollPeriod = 10ms;
constexpr auto kPatience = 10s;
constexpr std::size_t kMostErr = 1 << 16;

std::string trimmed(std::string text) {
  constexpr std::string_view kOwnName = "lcs: ";
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.starts_with(kOwnName) ? text.substr(kOwnName.size()) : text;
}

/// A run of this program as a child process.
class ChildProcess {
 public:
  /// \param its_place in the list of commands.
  ChildProcess(std::size_t its_place, const std::vector<std::string>& arguments)
      : place(its_place) {
    std::vector<std::string> command{kChildName};
    command.insert(command.end(), arguments.begin(), arguments.end());
    pid_ = process::start_child(scenario::program().c_str(), command, {.err = err_.descriptor()},
                                {.when_parent_ends = SIGTERM});
  }
  /// Ends the process if it still runs.
  ~ChildProcess() {
    if (poll()) return;
    ask_to_end();
    const Clock::time_point deadline = Clock::now() + kPatience;
    while (!poll() && Clock::now() < deadline) std::this_thread::sleep_for(kPollPeriod);
    if (!poll()) ::kill(pid_, SIGKILL);
    while (!poll()) std::this_thread::sleep_for(kPollPeriod);
  }

  /// How the process ended; absent while it runs.
  std::optional<Exit> poll() {
    int status = 0;
    if (exit_ || ::waitpid(pid_, &status, WNOHANG) != pid_) return exit_;
    exit_.emplace();
    exit_->code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    exit_->signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    exit_->err = err_.text(kMostErr);
    exit_->wall_s = std::chrono::duration<double>(Clock::now() - start_).count();
    return exit_;
  }

  void ask_to_end() const {
    if (!exit_) ::kill(pid_, SIGTERM);
  }

  const std::size_t place;

 private:
  using Clock = std::chrono::steady_clock;
  pid_t pid_ = -1;
  process::MemoryFile err_{"no process can be started (memfd_create)"};  ///< its stderr
  Clock::time_point start_ = Clock::now();
  std::optional<Exit> exit_;
};

/// Requests termination of all children before the destructor waits for the first one.
class Pool : public std::list<ChildProcess> {
 public:
  ~Pool() {
    for (const ChildProcess& child : *this) child.ask_to_end();
  }
};

}  // namespace

std::string complaint_of(const Exit& exit) {
  const std::string said = trimmed(exit.err);
  if (exit.signal != 0) {
    return fmt::format("crashed: ended by signal {} ({}){}{}", exit.signal,
                       ::strsignal(exit.signal), said.empty() ? "" : "; it said: ", said);
  }
  if ((exit.code == 2 || exit.code == kFaultyDisk) && !said.empty()) return said;
  return fmt::format("exited with {}{}{}", exit.code, said.empty() ? "" : "; it said: ", said);
}

std::vector<std::string> warnings_of(const Exit& exit) {
  constexpr std::string_view kBeginning = "warning: ";
  std::vector<std::string> warnings;
  std::istringstream lines(exit.err);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kBeginning)) warnings.push_back(line.substr(kBeginning.size()));
  }
  return warnings;
}

void run_all(const std::vector<std::vector<std::string>>& commands, std::size_t at_once,
             const std::function<void(std::size_t, const Exit&)>& on_exit,
             const std::function<void(const std::vector<std::size_t>&)>& on_tick) {
  Pool pool;
  std::size_t next = 0;
  while (next < commands.size() || !pool.empty()) {
    while (next < commands.size() && pool.size() < at_once) {
      pool.emplace_back(next, commands[next]);
      ++next;
    }
    for (auto child = pool.begin(); child != pool.end();) {
      const std::optional<Exit> exit = child->poll();
      if (!exit) {
        ++child;
        continue;
      }
      const std::size_t place = child->place;
      child = pool.erase(child);
      on_exit(place, *exit);
    }
    std::vector<std::size_t> running;
    for (const ChildProcess& child : pool) running.push_back(child.place);
    on_tick(running);
    std::this_thread::sleep_for(kPollPeriod);
  }
}

}  // namespace lcs::suite
