/// \file
/// Runs this program again in child processes.
#pragma once

#include <functional>
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

  /// Whether the process succeeded.
  bool is_fine() const { return code == 0 && signal == 0; }
};

/// The error message of a failed process: its signal or exit code and its stderr.
std::string complaint_of(const Exit& exit);

/// The lines of stderr that begin with "warning: ", without that prefix.
std::vector<std::string> warnings_of(const Exit& exit);

/// Runs this program with each of the commands (without the program's name) as a child process:
/// starts them in order, `at_once` of them at a time, and waits for them. Their stdout is
/// discarded. They get SIGTERM when the thread that calls this ends, even by SIGKILL.
/// \param on_exit called with a command's index when it ends.
/// \param on_tick called several times a second with the indices of the running commands.
/// \throws std::system_error, and an exception of a callback, after ending the running children:
///   by a termination request, after 10 s by SIGKILL.
void run_all(const std::vector<std::vector<std::string>>& commands, std::size_t at_once,
             const std::function<void(std::size_t, const Exit&)>& on_exit,
             const std::function<void(const std::vector<std::size_t>& running)>& on_tick);

}  // namespace lcs::suite
