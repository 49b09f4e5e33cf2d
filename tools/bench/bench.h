/// \file
/// The loop of a run: observation -> corners and signatures -> ego-motion -> detector -> record
/// with truth.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "filter/detect/event_corners.h"
#include "filter/detect/fast.h"
#include "scenarios/scenario.h"
#include "sim/camera/rectifier.h"
#include "sim/events/event.h"
#include "sim/simulation.h"
#include "tools/bench/detector.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// Finds the corners of a frame by the scenario's section `corners`. Call it with each frame, in
/// order: corners of events depend on all events before.
class CornerFinder {
 public:
  explicit CornerFinder(const scenario::Scenario& scenario)
      : fast_(scenario.fast_threshold),
        is_by_events_(scenario.corner_source == scenario::CornerSource::events) {}

  /// \param events since the frame before; not read if corners come from pictures.
  /// \return in pixels of the picture.
  std::vector<Eigen::Vector2f> find(const cv::Mat1b& grey, std::span<const sim::Event> events);

  /// The picture that signatures are of, in place of the camera's: the surface of active events.
  /// Absent if it is the camera's.
  std::optional<cv::Mat1b> surface() const;

 private:
  FastDetector fast_;
  bool is_by_events_;
  std::optional<EventCorners> events_;  ///< from the first frame on
};

/// Called with each finished frame and its image (BGR), in order. An exception ends the run.
using FrameSink = std::function<void(const recording::FrameRecord&, const cv::Mat3b& image)>;

/// Source of the frames of a run.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame: number, time and motions. Adds the time spent to the frame's times.
  /// \param image set to the camera's image, BGR. \return false after the last frame.
  virtual bool next(recording::FrameRecord& frame, cv::Mat3b& image) = 0;

  /// The events since the frame before the last one, up to the last one.
  virtual std::span<const sim::Event> events() const { return {}; }

  /// Undistorts corners and picture: from the recording camera to the pinhole camera of the
  /// detectors. Drops corners that are not scored.
  /// \param picture BGR or grey. \return whether it changed.
  virtual bool straighten(std::vector<Eigen::Vector2f>& corners_px, cv::Mat& picture) const = 0;

  /// Adds the truth of the frame's corners and objects, as far as it is known.
  virtual void label(recording::FrameRecord& frame) = 0;

  virtual std::optional<sim::Warnings> warnings() const { return std::nullopt; }
  /// Counts of the faults in the sensors' readings so far.
  virtual Diagnostics diagnostics() const = 0;
};

class SimulatedFrames : public FrameSource {
 public:
  /// \param scenario of the simulation. Keeps references to both.
  SimulatedFrames(const scenario::Scenario& scenario, sim::Simulation& simulation);

  bool next(recording::FrameRecord& frame, cv::Mat3b& image) override;
  bool straighten(std::vector<Eigen::Vector2f>& corners_px, cv::Mat& picture) const override;
  void label(recording::FrameRecord& frame) override;
  std::span<const sim::Event> events() const override { return observation_->events; }
  std::optional<sim::Warnings> warnings() const override { return simulation_.warnings(); }
  Diagnostics diagnostics() const override { return ego_motion_.estimator().diagnostics(); }

  /// The complete observation of the last frame. Once it is labelled, depth and objects of its
  /// truth are of the straightened picture.
  const std::optional<sim::Observation>& observation() const { return observation_; }

 private:
  const scenario::Scenario& scenario_;
  sim::Simulation& simulation_;
  EgoMotionFeed ego_motion_;
  sim::Rectifier rectifier_;
  std::optional<sim::Observation> observation_;  ///< of the last frame
};

/// A frame before detection.
struct InputFrame {
  recording::FrameRecord record;  ///< without verdicts and layers
  cv::Mat3b image;                ///< BGR
  cv::Mat1b grey;                 ///< grey image, input of corner detection
};

/// The next frame with corners, their truth, and signatures on request.
/// \return absent after the last frame. \throws the exceptions of the source.
std::optional<InputFrame> next_input_frame(FrameSource& source, CornerFinder& corners,
                                           bool are_signatures_wanted);

/// Stores a detector's result in a frame.
/// \param step_ms time of the detector, ms; stored in the field `step_time` unless that is null.
void store_result(const FrameResult& said, double recording::FrameTimes::*step_time, double step_ms,
                  recording::FrameRecord& frame);

/// Makes frames, and works on each of them, in their order.
/// \param threads 1 or 2: two make a frame while `work` is on the frame before, in another thread.
/// \throws the first exception of the two in the order of a single thread.
void for_each_frame(const std::function<std::optional<InputFrame>()>& make,
                    const std::function<void(InputFrame&)>& work, int threads);

/// The facts of a run of the scenario.
recording::RunInfo run_info(const scenario::Scenario& scenario, const sim::Simulation& simulation);

/// Runs a detector on a frame with known corners.
/// \param frame with corners, motion and optional signatures; receives verdicts, layers and times.
/// \param grey,image may be empty for a detector that does not use them.
void run_detector(Detector& detector, const cv::Mat3b& image, const cv::Mat1b& grey,
                  recording::FrameRecord& frame);

/// A detector of a run, and the destination of its results.
struct DetectorRun {
  Detector& detector;
  FrameSink sink;
};

/// What is known once all frames are processed.
struct RunEnd {
  /// For each detector, faults in the sensors' readings and in its detector's input.
  std::vector<Diagnostics> diagnostics;
  std::optional<sim::Warnings> warnings;  ///< of the simulation, if there is one
};

/// Processes all frames, and keeps none. Each detector gets the same frames as it would alone.
/// \param threads as of `for_each_frame`; with 2, detectors and sinks work in the second one.
/// \throws the exceptions of source, detectors and sinks.
RunEnd run(FrameSource& source, CornerFinder corners, std::span<const DetectorRun> detectors,
           int threads = 1);

/// Runs the simulation to its end. \param scenario of the simulation.
/// \return,\throws like the function above, and sim::PhysicsError.
RunEnd run(const scenario::Scenario& scenario, sim::Simulation& simulation,
           std::span<const DetectorRun> detectors, int threads = 1);

}  // namespace lcs::bench
