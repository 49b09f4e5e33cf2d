/// \file
/// The real `lcs` program as a child process.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lcs::test {

struct CommandResult {
  int exit_code = -1;  ///< 128 + signal if killed by a signal
  std::string out;
  std::string err;
  std::size_t peak_bytes = 0;  ///< peak memory of it or of a child that it waited for
};

struct CommandOptions {
  std::filesystem::path folder;                  ///< working folder
  std::optional<std::size_t> largest_file = {};  ///< bytes; writing more fails, as on a full disk
  std::optional<std::size_t> open_files = {};    ///< descriptors, including the three standard ones
  std::vector<int> closed = {};                  ///< of the standard descriptors
  std::filesystem::path out = {};                ///< standard output, instead of `out`
  std::optional<std::size_t> most_memory = {};   ///< bytes; `ulimit -v` takes kB
  bool obeys_permissions = false;                ///< of files, as for all users but root
};

/// Starts on construction; waits for the end on destruction at the latest.
class Command {
 public:
  /// \param arguments without the program's name.
  Command(const std::vector<std::string>& arguments, const CommandOptions& options);
  ~Command();
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  void send(int signal) const;
  pid_t pid() const { return pid_; }
  bool is_running();
  CommandResult wait();

 private:
  /// Whether it has ended. \param flags of `wait4`.
  bool collect(int flags);

  std::filesystem::path capture_;  ///< folder with its output
  pid_t pid_ = -1;
  std::optional<int> status_;
  std::size_t peak_bytes_ = 0;
};

CommandResult run_lcs(const std::vector<std::string>& arguments, const CommandOptions& options);

}  // namespace lcs::test
