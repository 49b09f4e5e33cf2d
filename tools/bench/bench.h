/// \file
/// The loop of a run: observation -> corners and their signatures -> ego-motion -> detector ->
/// record with truth.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "filter/detect/fast.h"
#include "scenarios/scenario.h"
#include "sim/simulation.h"
#include "tools/bench/detector.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// Called with every finished frame and its image (BGR), in order. What it throws ends the run.
using FrameSink = std::function<void(const FrameRecord&, const cv::Mat3b& image)>;

/// Where the frames of a run come from.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame: its number, time and motions. What this took is added to the frame's times.
  /// \param image set to what the camera saw, BGR. \return false after the last one.
  virtual bool next(FrameRecord& frame, cv::Mat3b& image) = 0;

  /// Undistorts corners and picture: from the camera that took it to the pinhole that detectors are
  /// told of. Corners that are not to be judged are left out.
  /// \return whether the picture was changed.
  virtual bool straighten(std::vector<Eigen::Vector2f>&, cv::Mat3b&) const { return false; }

  /// Adds the truth of the frame's corners and objects, so far as it is known.
  virtual void label(FrameRecord& frame) = 0;

  virtual std::optional<sim::Warnings> warnings() const { return std::nullopt; }
  /// What was wrong with the sensors' readings so far.
  virtual Diagnostics diagnostics() const = 0;
};

class SimulatedFrames : public FrameSource {
 public:
  /// \param scenario that the simulation was made of. Both are referred to.
  SimulatedFrames(const scenario::Scenario& scenario, sim::Simulation& simulation);

  bool next(FrameRecord& frame, cv::Mat3b& image) override;
  void label(FrameRecord& frame) override;
  std::optional<sim::Warnings> warnings() const override { return simulation_.warnings(); }
  Diagnostics diagnostics() const override { return ego_motion_.estimator().diagnostics(); }

  /// The whole observation of the last frame.
  const std::optional<sim::Observation>& observation() const { return observation_; }

 private:
  const scenario::Scenario& scenario_;
  sim::Simulation& simulation_;
  EgoMotionFeed ego_motion_;
  std::optional<sim::Observation> observation_;  ///< the last one
};

/// A frame before a detector has seen it.
struct SeenFrame {
  FrameRecord record;  ///< without verdicts and layers
  cv::Mat3b image;     ///< BGR
  cv::Mat1b grey;      ///< the same: what the corners were found in
};

/// The next frame with its corners and what is true of them, and signatures where they are wanted.
/// \return none after the last one. \throws what the source throws.
std::optional<SeenFrame> see(FrameSource& source, const FastDetector& detector,
                             bool are_signatures_wanted);

/// Stores in a frame what a detector says of it.
/// \param step_ms that the detector took: stored as the time that `step_time` points to, unless
/// that
///   is null.
void note(const FrameResult& said, double FrameTimes::*step_time, double step_ms,
          FrameRecord& frame);

/// A recording of the scenario without frames yet.
Recording begin_recording(const scenario::Scenario& scenario, const sim::Simulation& simulation);

/// Runs a detector on a frame whose corners are known.
/// \param frame with corners, motion, and signatures if there are any; gets verdicts, layers and
///   times.
/// \param grey,image may be empty for a detector that does not look at them.
void ask(Detector& detector, const cv::Mat3b& image, const cv::Mat1b& grey, FrameRecord& frame);

/// A detector that takes part in a run, and where its results go.
struct Watcher {
  Detector& detector;
  Recording& recording;  ///< gets every frame before the sink does, and in the end the warnings
  FrameSink sink;
};

/// Goes through all frames. Each watcher gets the same frames as it would alone.
/// \return for each watcher, what was wrong with the sensors' readings and with what its detector
/// was told. \throws what the source, detectors and sinks throw.
std::vector<Diagnostics> run(FrameSource& source, const FastDetector& detector,
                             std::span<const Watcher> watchers);

/// Runs the simulation to its end. \param scenario that the simulation was made of.
/// \return,\throws as above, and sim::PhysicsError.
std::vector<Diagnostics> run(const scenario::Scenario& scenario, sim::Simulation& simulation,
                             std::span<const Watcher> watchers);
/// The same for one detector.
Diagnostics run(const scenario::Scenario& scenario, sim::Simulation& simulation, Detector& detector,
                Recording& recording, const FrameSink& sink);

}  // namespace lcs::bench
