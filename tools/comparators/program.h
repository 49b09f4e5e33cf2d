/// \file
/// Any program as a detector: it is handed each frame on its standard input, and answers with a
/// line. Byte by byte in `tools/comparators/PROTOCOL.md`.
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

/// Version of the protocol; a program that greets with another one is refused.
inline constexpr int kProtocol = 1;

struct Program {
  std::string command;    ///< for `/bin/sh -c`
  double timeout_s = 30;  ///< for each answer, and to end
};

/// What a program is told before the first frame.
struct Announced {
  std::string scenario;
  std::uint64_t seed = 0;
  int frames = 0;  ///< 0: nobody knows
  double rate_hz = 0;
  Intrinsics camera;
  bool compressed = false;  ///< pictures are those that an earlier run kept
};

class ProgramDetector : public bench::Detector {
 public:
  /// Starts the program, tells it what comes, and waits for its greeting.
  /// \param name for messages. \param on_wait as `DetectorProcess` has it.
  /// \throws DetectorError for whatever goes wrong with it, naming it and the frame.
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
