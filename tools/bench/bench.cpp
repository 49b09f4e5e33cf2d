#include "tools/bench/bench.h"

#include <opencv2/imgproc.hpp>
#include <optional>

#include "tools/bench/ego_motion_feed.h"
#include "tools/bench/timed.h"

namespace lcs::bench {
Recording begin_recording(const scenario::Scenario& scenario, const sim::Simulation& simulation) {
  Recording recording;
  recording.scenario = scenario.name;
  recording.seed = scenario.seed;
  recording.world = scenario.world;
  recording.objects = simulation.objects();
  return recording;
}

void watch(const cv::Mat3b& image, const FastDetector& detector, Tracker& tracker,
           FrameRecord& frame) {
  double detect_ms = 0;
  cv::Mat1b grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  frame.corners_px = timed(detect_ms, [&] { return detector.detect(grey); });
  ask(tracker, image, grey, frame);
  frame.times->detect_ms = detect_ms;
}

void ask(Tracker& tracker, const cv::Mat3b& image, const cv::Mat1b& grey, FrameRecord& frame) {
  FrameTimes times;
  const FrameResult& result = timed(times.filter_ms, [&]() -> const FrameResult& {
    return tracker.step({image, grey, frame.corners_px, frame.motion});
  });
  frame.verdicts = result.verdicts;
  frame.reasons = result.reasons;
  frame.layers = result.layers;
  times.line_ms = result.times.line_ms;
  times.circle_ms = result.times.circle_ms;
  times.square_ms = result.times.square_ms;
  frame.times = times;
}

Diagnostics run(const scenario::Scenario& scenario, sim::Simulation& simulation, Tracker& tracker,
                Recording& recording, const FrameSink& sink) {
  const FastDetector detector(scenario.fast_threshold);
  const sim::Pinhole& camera = simulation.calibration().camera;
  EgoMotionFeed ego_motion(scenario, simulation.calibration());

  while (true) {
    double simulate_ms = 0;
    const std::optional<sim::Observation> observation =
        timed(simulate_ms, [&] { return simulation.next(); });
    if (!observation) break;
    FrameRecord& frame = recording.frames.emplace_back();
    frame.index = observation->index;
    frame.t_ns = observation->t_ns;
    const EgoMotionFeed::Motions motions = ego_motion.next(*observation);
    frame.motion = motions.told;
    frame.true_motion = motions.exact;
    watch(observation->image, detector, tracker, frame);

    frame.times->simulate_ms = simulate_ms;
    frame.corner_truth = timed(frame.times->truth_ms, [&] {
      return sim::label_corners(camera, observation->truth, frame.corners_px,
                                scenario.truth_min_depth_m);
    });
    frame.object_truth = observation->objects;
    sink(frame, observation->image);
  }
  recording.warnings = simulation.warnings();
  Diagnostics diagnostics = ego_motion.estimator().diagnostics();
  diagnostics += tracker.diagnostics();
  return diagnostics;
}

}  // namespace lcs::bench
