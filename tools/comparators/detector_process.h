/// \file
/// A program that is asked line by line: its standard input and output are pipes, and it answers
/// each question with one line. What it writes to stderr is kept, for what there is to tell.
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

namespace lcs::comparators {

/// What is wrong with a detector that is a program, and what to do about it.
class DetectorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bytes of a line that answers a frame; and the field of the greeting that asks for more, and how
/// much it can ask for. Parsed, a line takes thirty times as much.
inline constexpr std::size_t kMostAnswer = 1'000'000, kMostAskedAnswer = 16'000'000;
inline constexpr const char* kAnswerBytes = "answer_bytes";

/// The program and all processes that it starts are in a process group of their own, which is ended
/// with this object: Ctrl-C does not reach them, and none stays behind.
class DetectorProcess {
 public:
  /// \param command for `/bin/sh -c`. All that it starts ends with this process, also where that is
  ///   ended by SIGKILL, but for what leaves the process group.
  /// \param timeout_s that the program may take to answer, and to end.
  /// \param on_wait called some times a second while it is waited for; what it throws ends that.
  /// \throws std::system_error where no process can be started.
  DetectorProcess(const std::string& command, double timeout_s, std::function<void()> on_wait);
  ~DetectorProcess();
  DetectorProcess(const DetectorProcess&) = delete;
  DetectorProcess& operator=(const DetectorProcess&) = delete;

  /// Hands over a line (its end included) and the bytes behind it.
  /// \return the line that answers it, without its end.
  /// \throws DetectorError: it ended, closed its input, took too long, or did not read all.
  std::string ask(std::string_view line, std::span<const unsigned char> bytes = {});

  /// Tells it that nothing more comes, and waits for its end.
  /// \throws DetectorError for another exit code than 0, or an answer that nobody asked for.
  void finish();

  /// How long a line it may write, without its end; `kMostAnswer` if it was not said.
  void allow_answer(std::size_t bytes) { most_answer_ = bytes; }

  /// The last lines that it wrote to stderr.
  std::vector<std::string> said() const;

 private:
  using Clock = std::chrono::steady_clock;
  class Pipe {
   public:
    Pipe() = default;
    ~Pipe() { close(); }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    void take(int descriptor);
    void close();
    int get() const { return descriptor_; }
    bool is_open() const { return descriptor_ >= 0; }

   private:
    int descriptor_ = -1;
  };

  Clock::time_point time_is_up() const;  ///< of what is asked now
  void wait(bool to_write, Clock::time_point deadline) const;
  void read_what_is_there();
  void write_some(std::string_view& first, std::string_view& second);
  [[noreturn]] void fail_ended();
  void wait_for_end(Clock::time_point deadline);
  bool has_ended() const;
  void end_group(int signal) const;
  void reap();
  std::string with_stderr(const std::string& what) const;

  double timeout_s_;
  std::function<void()> on_wait_;
  pid_t pid_ = -1;
  std::optional<int> status_;  ///< of waitpid, once it was called
  std::size_t most_answer_ = kMostAnswer;
  Pipe in_, out_, err_;  ///< its
  Pipe lifeline_;        ///< nothing is written to it
  std::string answers_;  ///< read, and not asked for yet
  std::string stderr_;   ///< the last of it
};

}  // namespace lcs::comparators
