#include "tools/bench/bench.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "filter/detect/describe.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/bench/timed.h"

namespace lcs::bench {
namespace {

class SimulatedFrames : public FrameSource {
 public:
  SimulatedFrames(const scenario::Scenario& scenario, sim::Simulation& simulation)
      : scenario_(scenario),
        simulation_(simulation),
        ego_motion_(scenario, simulation.calibration()) {}

  bool next(FrameRecord& frame, cv::Mat3b& image) override {
    observation_ = timed(frame.times.value().simulate_ms, [&] { return simulation_.next(); });
    if (!observation_) return false;
    frame.index = observation_->index;
    frame.t_ns = observation_->t_ns;
    const EgoMotionFeed::Motions motions = ego_motion_.next(*observation_);
    frame.motion = motions.told;
    frame.true_motion = motions.exact;
    image = observation_->image;
    return true;
  }

  void label(FrameRecord& frame) override {
    frame.corner_truth = timed(frame.times.value().truth_ms, [&] {
      return sim::label_corners(simulation_.calibration().camera, observation_->truth,
                                frame.corners_px, scenario_.truth_min_depth_m);
    });
    frame.object_truth = observation_->objects;
  }

  std::optional<sim::Warnings> warnings() const override { return simulation_.warnings(); }
  Diagnostics diagnostics() const override { return ego_motion_.estimator().diagnostics(); }

 private:
  const scenario::Scenario& scenario_;
  sim::Simulation& simulation_;
  EgoMotionFeed ego_motion_;
  std::optional<sim::Observation> observation_;  ///< the last one
};

}  // namespace

Recording begin_recording(const scenario::Scenario& scenario, const sim::Simulation& simulation) {
  Recording recording;
  recording.scenario = scenario.name;
  recording.seed = scenario.seed;
  recording.world = scenario.world;
  recording.objects = simulation.objects();
  return recording;
}

void ask(Tracker& tracker, const cv::Mat3b& image, const cv::Mat1b& grey, FrameRecord& frame) {
  FrameTimes times = frame.times.value_or(FrameTimes{});
  const FrameResult& result = timed(times.filter_ms, [&]() -> const FrameResult& {
    return tracker.step({image, grey, frame.corners_px, frame.motion, frame.signatures});
  });
  frame.verdicts = result.verdicts;
  frame.reasons = result.reasons;
  frame.layers = result.layers;
  times.line_ms = result.times.line_ms;
  times.circle_ms = result.times.circle_ms;
  times.square_ms = result.times.square_ms;
  frame.times = times;
}

std::vector<Diagnostics> run(FrameSource& source, const FastDetector& detector,
                             std::span<const Watcher> watchers) {
  const bool are_signatures_wanted =
      std::any_of(watchers.begin(), watchers.end(),
                  [](const Watcher& watcher) { return watcher.tracker.wants_signatures(); });

  while (true) {
    FrameRecord seen;  // by all
    FrameTimes& times = seen.times.emplace();
    cv::Mat3b image;
    if (!source.next(seen, image)) break;
    cv::Mat1b grey;
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    const int threshold = detector.threshold(grey);
    seen.corners_px =
        timed(times.detect_ms, [&] { return FastDetector::detect(grey, threshold); });
    if (source.straighten(seen.corners_px, image)) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    std::vector<Signature> signatures;  // only for those who want them, as alone
    double describe_ms = 0;
    if (are_signatures_wanted) {
      signatures = timed(describe_ms, [&] { return describe(grey, seen.corners_px); });
    }
    source.label(seen);
    for (const Watcher& watcher : watchers) {
      FrameRecord& frame = watcher.recording.frames.emplace_back(seen);
      if (watcher.tracker.wants_signatures()) {
        frame.signatures = signatures;
        frame.times->describe_ms = describe_ms;
      }
      ask(watcher.tracker, image, grey, frame);
      watcher.sink(frame, image);
    }
  }
  std::vector<Diagnostics> all;
  for (const Watcher& watcher : watchers) {
    watcher.recording.warnings = source.warnings();
    all.push_back(source.diagnostics());
    all.back() += watcher.tracker.diagnostics();
  }
  return all;
}

std::vector<Diagnostics> run(const scenario::Scenario& scenario, sim::Simulation& simulation,
                             std::span<const Watcher> watchers) {
  SimulatedFrames frames(scenario, simulation);
  return run(frames, FastDetector(scenario.fast_threshold), watchers);
}

Diagnostics run(const scenario::Scenario& scenario, sim::Simulation& simulation, Tracker& tracker,
                Recording& recording, const FrameSink& sink) {
  const Watcher watcher{tracker, recording, sink};
  return run(scenario, simulation, {&watcher, 1}).front();
}

}  // namespace lcs::bench
