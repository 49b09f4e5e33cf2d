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
  const int threshold = detector.threshold(grey);
  frame.corners_px = timed(detect_ms, [&] { return FastDetector::detect(grey, threshold); });
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

std::vector<Diagnostics> run(const scenario::Scenario& scenario, sim::Simulation& simulation,
                             std::span<const Watcher> watchers) {
  const FastDetector detector(scenario.fast_threshold);
  const sim::Pinhole& camera = simulation.calibration().camera;
  EgoMotionFeed ego_motion(scenario, simulation.calibration());

  while (true) {
    FrameTimes times;
    const std::optional<sim::Observation> observation =
        timed(times.simulate_ms, [&] { return simulation.next(); });
    if (!observation) break;
    FrameRecord seen;  // by all
    seen.index = observation->index;
    seen.t_ns = observation->t_ns;
    const EgoMotionFeed::Motions motions = ego_motion.next(*observation);
    seen.motion = motions.told;
    seen.true_motion = motions.exact;
    cv::Mat1b grey;
    cv::cvtColor(observation->image, grey, cv::COLOR_BGR2GRAY);
    const int threshold = detector.threshold(grey);
    seen.corners_px = timed(times.detect_ms, [&] { return FastDetector::detect(grey, threshold); });
    seen.corner_truth = timed(times.truth_ms, [&] {
      return sim::label_corners(camera, observation->truth, seen.corners_px,
                                scenario.truth_min_depth_m);
    });
    seen.object_truth = observation->objects;
    for (const Watcher& watcher : watchers) {
      FrameRecord& frame = watcher.recording.frames.emplace_back(seen);
      ask(watcher.tracker, observation->image, grey, frame);
      frame.times->simulate_ms = times.simulate_ms;
      frame.times->detect_ms = times.detect_ms;
      frame.times->truth_ms = times.truth_ms;
      watcher.sink(frame, observation->image);
    }
  }
  std::vector<Diagnostics> all;
  for (const Watcher& watcher : watchers) {
    watcher.recording.warnings = simulation.warnings();
    all.push_back(ego_motion.estimator().diagnostics());
    all.back() += watcher.tracker.diagnostics();
  }
  return all;
}

Diagnostics run(const scenario::Scenario& scenario, sim::Simulation& simulation, Tracker& tracker,
                Recording& recording, const FrameSink& sink) {
  const Watcher watcher{tracker, recording, sink};
  return run(scenario, simulation, {&watcher, 1}).front();
}

}  // namespace lcs::bench
