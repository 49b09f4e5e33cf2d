/// \file
/// This program again, as child processes.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lcs::suite {

/// How a process ended.
struct Exit {
  int code = 0;     ///< what it returned, when no signal ended it
  int signal = 0;   ///< that ended it, or 0
  std::string err;  ///< what it wrote to stderr, or the last of it when that is long
  double wall_s = 0;
};

/// What went wrong with a process that did not do what it was to do, in its own words if it had
/// some.
std::string complaint_of(const Exit& exit);

/// What it warned of: its lines that begin so, without that beginning.
std::vector<std::string> warnings_of(const Exit& exit);

/// One run of this very program. Its stdout is dropped. It is asked to end when the thread ends
/// that made it, also by SIGKILL.
class ChildProcess {
 public:
  /// \param arguments after the program's name. \throws std::system_error
  explicit ChildProcess(const std::vector<std::string>& arguments);
  /// Ends the process if it still runs: asks first, and insists after a while.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// How it ended; none while it runs.
  std::optional<Exit> poll();
  /// Asks it to end, as Ctrl-C would.
  void ask_to_end() const;

 private:
  using Clock = std::chrono::steady_clock;
  pid_t pid_ = -1;
  int err_ = -1;  ///< file without a name that takes its stderr
  Clock::time_point start_ = Clock::now();
  std::optional<Exit> exit_;
};

/// Runs all commands, `at_once` of them at a time, in order.
/// \param on_exit called with the place of the command, in the order in which they end.
/// \param on_tick called some times a second with the places of those that run.
/// What a callback throws ends the children that run.
void run_all(const std::vector<std::vector<std::string>>& commands, std::size_t at_once,
             const std::function<void(std::size_t, const Exit&)>& on_exit,
             const std::function<void(const std::vector<std::size_t>& running)>& on_tick);

}  // namespace lcs::suite
