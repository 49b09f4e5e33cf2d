/// \file
/// The real `lcs` program as a child process.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lcs::bench {

struct CommandResult {
  int exit_code = -1;  ///< 128 + signal when it was killed by one
  std::string out;
  std::string err;
  std::size_t peak_bytes = 0;  ///< of memory that it, or a child that it waited for, held at a time
};

struct CommandOptions {
  std::filesystem::path folder;                  ///< that it runs in
  std::optional<std::size_t> largest_file = {};  ///< bytes; writing more fails, as on a full disk
  std::optional<std::size_t> open_files = {};    ///< descriptors, the three standard ones included
  std::vector<int> closed = {};                  ///< of the standard descriptors
  std::filesystem::path out = {};                ///< for standard output, in place of `out`
  std::optional<std::size_t> most_memory = {};   ///< bytes, as `ulimit -v` has it in kB
  bool obeys_permissions = false;                ///< of files, as all users but root do
};

/// Started on construction; waited for at the latest on destruction.
class Command {
 public:
  /// \param arguments after the program's name.
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

  std::filesystem::path capture_;  ///< folder with what it printed
  pid_t pid_ = -1;
  std::optional<int> status_;
  std::size_t peak_bytes_ = 0;
};

CommandResult run_lcs(const std::vector<std::string>& arguments, const CommandOptions& options);

}  // namespace lcs::bench
