/// \file
/// The loop of a run: observation -> corners -> ego-motion -> tracker -> record with truth.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "filter/detect/fast.h"
#include "scenarios/scenario.h"
#include "sim/simulation.h"
#include "tools/bench/recording.h"
#include "tools/bench/tracker.h"

namespace lcs::bench {

/// Called with every finished frame and its image (BGR), in order. What it throws ends the run.
using FrameSink = std::function<void(const FrameRecord&, const cv::Mat3b& image)>;

/// A recording of the scenario without frames yet.
Recording begin_recording(const scenario::Scenario& scenario, const sim::Simulation& simulation);

/// Finds the corners of a picture and asks a tracker about them.
/// \param frame whose motion is known; gets corners, verdicts, layers, and the times of all that.
void watch(const cv::Mat3b& image, const FastDetector& detector, Tracker& tracker,
           FrameRecord& frame);

/// Asks a tracker about corners that are known.
/// \param frame whose corners and motion are known; gets verdicts, layers, and the times of that.
/// \param grey,image may be empty for a tracker that does not look at them.
void ask(Tracker& tracker, const cv::Mat3b& image, const cv::Mat1b& grey, FrameRecord& frame);

/// One of those who watch a run.
struct Watcher {
  Tracker& tracker;
  Recording& recording;  ///< is given every frame before the sink sees it, and the warnings last
  FrameSink sink;
};

/// Runs the simulation to its end. Who watches beside others gets the same frames as alone.
/// \param scenario that the simulation was made of.
/// \return for each watcher, what was wrong with the sensors' readings and with what its tracker
/// was
///   told.
/// \throws sim::PhysicsError, and what trackers and sinks throw.
std::vector<Diagnostics> run(const scenario::Scenario& scenario, sim::Simulation& simulation,
                             std::span<const Watcher> watchers);
/// Of one alone.
Diagnostics run(const scenario::Scenario& scenario, sim::Simulation& simulation, Tracker& tracker,
                Recording& recording, const FrameSink& sink);

}  // namespace lcs::bench
