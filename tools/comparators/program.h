/// \file
/// An external program as a detector: it gets each frame on its standard input and answers with a
/// line. The format is specified in `tools/comparators/PROTOCOL.md`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "filter/ego_motion/intake.h"
#include "tools/bench/detector.h"
#include "tools/comparators/detector_process.h"
#include "tools/recording/frame_detections.h"

namespace lcs::comparators {

/// Protocol version; programs that greet with another one are rejected.
inline constexpr int kProtocol = 1;

struct Program {
  std::string command;    ///< for `/bin/sh -c`
  double timeout_s = 30;  ///< limit for each answer, and for the exit
};

/// Data sent to a program before the first frame.
struct Announced {
  std::string scenario;
  std::uint64_t seed = 0;
  int frames = 0;  ///< 0: unknown
  double rate_hz = 0;
  Intrinsics camera;
  bool compressed = false;  ///< pictures come from an earlier run
};

class ProgramDetector : public bench::Detector {
 public:
  /// Starts the program, sends the announcement, and waits for its greeting.
  /// \param name for messages. \param on_wait as in `DetectorProcess`.
  /// \throws DetectorError for any error of the program, naming it and the frame.
  ProgramDetector(std::string name, const Program& program, const Announced& announced,
                  std::function<void()> on_wait);

  const FrameResult& step(const bench::DetectorInput& input) override;
  double bench::FrameTimes::*step_time() const override { return &bench::FrameTimes::process_ms; }
  bool gives_circles() const override { return gives_circles_; }
  const bench::SquareMasks& masks() const override { return masks_; }
  void finish() override;
  Diagnostics diagnostics() const override { return diagnostics_; }
  std::vector<std::string> told() const override;

 private:
  void greet(const Announced& announced);
  void read_answer(const std::string& line, bench::FrameRecord& frame);

  std::string name_;
  Intrinsics camera_;
  DetectorProcess process_;
  bool gives_circles_ = false;
  Intake intake_;
  Diagnostics diagnostics_;
  bench::VerdictCounts counts_;
  FrameResult result_;
  bench::SquareMasks masks_;
};

}  // namespace lcs::comparators
