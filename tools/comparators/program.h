/// \file
/// An external program as a detector: it gets each frame on its standard input and answers with a
/// line. The format is specified in `tools/comparators/PROTOCOL.md`.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "filter/ego_motion/intake.h"
#include "scenarios/scenario.h"
#include "tools/bench/detector.h"
#include "tools/comparators/detector_process.h"
#include "tools/recording/detections.h"

namespace lcs::comparators {

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
