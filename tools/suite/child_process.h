/// \file
/// Runs this program again in child processes.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lcs::suite {

/// The program's name in a child process. A child that a disk keeps from reading or writing a file,
/// as a full one, exits with `kFaultyDisk`, in contrast to a child of a faulty scenario.
inline constexpr const char* kChildName = "lcs-child";
inline constexpr int kFaultyDisk = 3;

/// How a process ended.
struct Exit {
  int code = 0;     ///< exit code, if no signal ended the process
  int signal = 0;   ///< the signal that ended the process, or 0
  std::string err;  ///< its stderr, or the last 64 KiB
  double wall_s = 0;
};

/// The error message of a failed process: its signal or exit code and its stderr.
std::string complaint_of(const Exit& exit);

/// The lines of stderr that begin with "warning: ", without that prefix.
std::vector<std::string> warnings_of(const Exit& exit);

/// A run of this program as a child process. Its stdout is discarded. It gets SIGTERM when the
/// thread that made it ends, even by SIGKILL.
class ChildProcess {
 public:
  /// \param arguments without the program's name. \throws std::system_error
  explicit ChildProcess(const std::vector<std::string>& arguments);
  /// Ends the process if it still runs: by a termination request, after 10 s by SIGKILL.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// How the process ended; absent while it runs.
  std::optional<Exit> poll();
  /// Requests termination by SIGTERM.
  void ask_to_end() const;

 private:
  using Clock = std::chrono::steady_clock;
  pid_t pid_ = -1;
  int err_ = -1;  ///< unnamed file (memfd) for its stderr
  Clock::time_point start_ = Clock::now();
  std::optional<Exit> exit_;
};

/// Starts all commands in order, `at_once` of them at a time, and waits for them.
/// \param on_exit called with a command's index when it ends.
/// \param on_tick called several times a second with the indices of the running commands.
/// \throws an exception of a callback, after ending the running children.
void run_all(const std::vector<std::vector<std::string>>& commands, std::size_t at_once,
             const std::function<void(std::size_t, const Exit&)>& on_exit,
             const std::function<void(const std::vector<std::size_t>& running)>& on_tick);

}  // namespace lcs::suite
