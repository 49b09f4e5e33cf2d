/// \file
/// An external program as a detector: it gets each frame on its standard input and answers with a
/// line. The format is specified in `tools/comparators/PROTOCOL.md`.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "filter/ego_motion/intake.h"
#include "scenarios/input/descriptor.h"
#include "scenarios/scenario.h"
#include "tools/bench/detector.h"
#include "tools/recording/detections.h"

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

/// Runs a program that answers each line of input with one line of output, through pipes on its
/// standard files. Keeps its stderr for error messages.
///
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

/// Protocol version; programs that greet with another one are rejected.
inline constexpr int kProtocol = 1;

struct Program {
  std::string command;    ///< for `/bin/sh -c`
  double timeout_s = 30;  ///< limit for each answer, and for the exit
};

/// Context of a detector's construction.
struct DetectorContext {
  const Intrinsics& camera;
  const scenario::Scenario& scenario;
  std::filesystem::path recorded = {};  ///< folder of the run that provides the frames; "": none
  int frames = 0;                       ///< number of frames; 0: unknown
  std::function<void()> on_wait = {};   ///< as in `DetectorProcess`
};

class ProgramDetector : public bench::Detector {
 public:
  /// Starts the program, sends the announcement, and waits for its greeting.
  /// \param name for messages.
  /// \throws DetectorError for any error of the program, naming it and the frame.
  ProgramDetector(std::string name, const Program& program, const DetectorContext& context);

  const FrameResult& step(const bench::DetectorInput& input) override;
  double recording::FrameTimes::*step_time() const override {
    return &recording::FrameTimes::process_ms;
  }
  bool gives_circles() const override { return gives_circles_; }
  const recording::SquareMasks& masks() const override { return masks_; }
  void finish() override;
  Diagnostics diagnostics() const override { return diagnostics_; }
  std::vector<std::string> remarks() const override;

 private:
  void greet(const DetectorContext& context);
  void read_answer(const std::string& line, recording::FrameRecord& frame);

  std::string name_;
  Intrinsics camera_;
  DetectorProcess process_;
  bool gives_circles_ = false;
  Intake intake_;
  Diagnostics diagnostics_;
  recording::VerdictCounts counts_;
  FrameResult result_;
  recording::SquareMasks masks_;
};

}  // namespace lcs::comparators
