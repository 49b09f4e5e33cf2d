#include "tools/bench/bench.h"

#include <opencv2/imgproc.hpp>
#include <optional>

#include "filter/detect/fast.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/bench/timed.h"

namespace lcs::bench {
Recording begin_recording(const scenario::Scenario& scenario, const sim::Simulation& simulation) {
  Recording recording;
  recording.scenario = scenario.name;
  recording.seed = scenario.seed;
  recording.objects = simulation.objects();
  return recording;
}

void run(const scenario::Scenario& scenario, sim::Simulation& simulation, Tracker& tracker,
         Recording& recording, const FrameSink& sink) {
  const FastDetector detector(scenario.fast_threshold);
  const sim::Pinhole& camera = simulation.calibration().camera;
  EgoMotionFeed ego_motion(scenario, simulation.calibration());

  while (true) {
    FrameTimes times;
    const std::optional<sim::Observation> observation =
        timed(times.simulate_ms, [&] { return simulation.next(); });
    if (!observation) return;
    FrameRecord& frame = recording.frames.emplace_back();
    frame.index = observation->index;
    frame.t_ns = observation->t_ns;

    cv::Mat1b grey;
    cv::cvtColor(observation->image, grey, cv::COLOR_BGR2GRAY);
    frame.corners_px = timed(times.detect_ms, [&] { return detector.detect(grey); });

    const EgoMotionFeed::Motions motions = ego_motion.next(*observation);
    frame.motion = motions.told;
    frame.true_motion = motions.exact;

    const FrameResult& result = timed(times.filter_ms, [&]() -> const FrameResult& {
      return tracker.step({observation->image, grey, frame.corners_px, frame.motion});
    });
    frame.verdicts = result.verdicts;
    frame.reasons = result.reasons;
    frame.layers = result.layers;
    times.line_ms = result.times.line_ms;
    times.circle_ms = result.times.circle_ms;
    times.square_ms = result.times.square_ms;

    frame.corner_truth = timed(times.truth_ms, [&] {
      return sim::label_corners(camera, observation->truth, frame.corners_px,
                                scenario.truth_min_depth_m);
    });
    frame.object_truth = observation->objects;
    frame.times = times;
    sink(frame, observation->image);
  }
}

}  // namespace lcs::bench
