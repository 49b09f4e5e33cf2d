/// \file
/// A run of a simulation with all of its frames in memory.
#pragma once

#include "tools/bench/bench.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// \param recording receives the frames up to an exception of the detector or the sink.
inline void run_into(
    recording::Recording& recording, const scenario::Scenario& scenario,
    sim::Simulation& simulation, Detector& detector,
    const FrameSink& sink = [](const recording::FrameRecord&, const cv::Mat3b&) {}) {
  const DetectorRun one{detector, [&](const recording::FrameRecord& frame, const cv::Mat3b& image) {
                          recording.frames.push_back(frame);
                          sink(frame, image);
                        }};
  recording.warnings = run(scenario, simulation, {&one, 1}).warnings;
}

}  // namespace lcs::bench
