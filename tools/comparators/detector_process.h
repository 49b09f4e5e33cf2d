/// \file
/// Runs a program that answers each line of input with one line of output, through pipes on its
/// standard files. Keeps its stderr for error messages.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/input/descriptor.h"

namespace lcs::comparators {

/// An error of an external detector program, with a remedy.
class DetectorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Default limit of an answer's bytes, the greeting's field that raises it, and the largest limit.
/// A parsed line takes thirty times as much memory.
inline constexpr std::size_t kMostAnswer = 1'000'000, kMostAskedAnswer = 16'000'000;
inline constexpr const char* kAnswerBytes = "answer_bytes";

/// The program and all its children form their own process group, which is ended with this object.
/// Ctrl-C does not reach them, and none is left behind.
class DetectorProcess {
 public:
  /// \param command for `/bin/sh -c`. Its process group is ended with this process, even by
  ///   SIGKILL; processes that leave the group are not.
  /// \param timeout_s limit for each answer and for the exit.
  /// \param on_wait called several times a second while waiting; its exceptions end the wait.
  /// \throws std::system_error if no process can be started.
  DetectorProcess(const std::string& command, double timeout_s, std::function<void()> on_wait);
  ~DetectorProcess();

  /// Sends a line (including its end) and the bytes after it.
  /// \return the answering line, without its end.
  /// \throws DetectorError if it ended, closed its input, timed out or did not read everything.
  std::string request(std::string_view line, std::span<const unsigned char> bytes = {});

  /// Closes its input and waits for its exit.
  /// \throws DetectorError for a non-zero exit code or an unexpected answer.
  void finish();

  /// Sets the longest line that it may write, without the end; default `kMostAnswer`.
  void allow_answer(std::size_t bytes) { most_answer_ = bytes; }

  /// The last lines of its stderr.
  std::vector<std::string> said() const;

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point time_is_up() const;  ///< of the current request
  void wait(bool to_write, Clock::time_point deadline) const;
  void read_what_is_there();
  void write_some(std::string_view& first, std::string_view& second);
  [[noreturn]] void fail_ended();
  void wait_for_end(Clock::time_point deadline);
  bool has_ended() const;
  void reap();
  std::string with_stderr(const std::string& what) const;

  double timeout_s_;
  std::function<void()> on_wait_;
  pid_t pid_ = -1;
  std::optional<int> status_;  ///< of waitpid, once called
  std::size_t most_answer_ = kMostAnswer;
  input::Descriptor in_, out_, err_;  ///< standard files of the program
  input::Descriptor lifeline_;        ///< never written to; its end ends the group
  std::string answers_;               ///< read but not yet requested
  std::string stderr_;                ///< the last part of it
};

}  // namespace lcs::comparators
