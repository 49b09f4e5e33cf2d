/// \file
/// A run of a simulation with all of its frames in memory.
#pragma once

#include "tools/bench/bench.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// \param recording receives the frames up to an exception of the detector or the sink.
inline void run_into(
    Recording& recording, const scenario::Scenario& scenario, sim::Simulation& simulation,
    Detector& detector, const FrameSink& sink = [](const FrameRecord&, const cv::Mat3b&) {}) {
  const Watcher watcher{detector, [&](const FrameRecord& frame, const cv::Mat3b& image) {
                          recording.frames.push_back(frame);
                          sink(frame, image);
                        }};
  recording.warnings = run(scenario, simulation, {&watcher, 1}).warnings;
}

}  // namespace lcs::bench
