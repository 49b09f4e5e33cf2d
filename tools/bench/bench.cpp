#include "tools/bench/bench.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <opencv2/imgproc.hpp>

#include "filter/detect/describe.h"
#include "tools/bench/timed.h"

namespace lcs::bench {

SimulatedFrames::SimulatedFrames(const scenario::Scenario& scenario, sim::Simulation& simulation)
    : scenario_(scenario),
      simulation_(simulation),
      ego_motion_(scenario, simulation.calibration()),
      rectifier_(simulation.calibration().optics.lens(),
                 simulation.calibration().optics.size_px()) {}

bool SimulatedFrames::next(recording::FrameRecord& frame, cv::Mat3b& image) {
  // The renderer and MuJoCo have threads of their own.
  observation_ = timed<std::chrono::steady_clock>(frame.times.value().simulate_ms,
                                                  [&] { return simulation_.next(); });
  if (!observation_) return false;
  frame.index = observation_->index;
  frame.t_ns = observation_->t_ns;
  const EgoMotionFeed::Motions motions = ego_motion_.next(*observation_);
  frame.motion = motions.told;
  frame.true_motion = motions.exact;
  image = observation_->image;
  return true;
}

bool SimulatedFrames::straighten(std::vector<Eigen::Vector2f>& corners_px, cv::Mat& picture) const {
  rectifier_.rectify(corners_px);
  rectifier_.rectify(picture);
  return !rectifier_.is_pinhole();
}

void SimulatedFrames::label(recording::FrameRecord& frame) {
  sim::FrameTruth& truth = observation_->truth;
  frame.corner_truth = timed(frame.times.value().truth_ms, [&] {
    return sim::label_corners(simulation_.calibration().camera, truth, frame.corners_px,
                              scenario_.truth_min_depth_m, &simulation_.calibration().optics);
  });
  frame.object_truth = rectifier_.rectified(observation_->objects, truth.object);
  for (cv::Mat1i* ids : {&truth.object, &truth.part, &truth.shadow_edge}) rectifier_.rectify(*ids);
  rectifier_.rectify(truth.depth_m);
}

std::optional<InputFrame> next_input_frame(FrameSource& source, CornerFinder& corners,
                                           bool are_signatures_wanted) {
  InputFrame seen;
  recording::FrameRecord& frame = seen.record;
  cv::Mat3b& image = seen.image;
  cv::Mat1b& grey = seen.grey;
  recording::FrameTimes& times = frame.times.emplace();
  if (!source.next(frame, image)) return std::nullopt;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  frame.corners_px = timed(times.detect_ms, [&] { return corners.find(grey, source.events()); });
  if (source.straighten(frame.corners_px, image)) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  if (are_signatures_wanted) {
    frame.signatures = timed(times.describe_ms, [&] {
      std::optional<cv::Mat1b> surface = corners.surface();
      std::vector<Eigen::Vector2f> none;
      if (surface) source.straighten(none, *surface);
      return describe(surface.value_or(grey), frame.corners_px);
    });
  }
  source.label(frame);
  return seen;
}

void store_result(const FrameResult& said, double recording::FrameTimes::*step_time, double step_ms,
                  recording::FrameRecord& frame) {
  frame.verdicts = said.verdicts;
  frame.reasons = said.reasons;
  frame.log_odds = said.log_odds;
  for (float& odds : frame.log_odds) odds = std::round(100 * odds) / 100;
  frame.layers = said.layers;
  frame.paper = said.paper;
  frame.gaps = said.gaps;
  if (step_time == nullptr) return;
  recording::FrameTimes times = frame.times.value_or(recording::FrameTimes{});
  times.*step_time = step_ms;
  times.line_ms = said.times.line_ms;
  times.circle_ms = said.times.circle_ms;
  times.square_ms = said.times.square_ms;
  frame.times = times;
}

recording::RunInfo run_info(const scenario::Scenario& scenario, const sim::Simulation& simulation) {
  recording::RunInfo run;
  run.scenario = scenario.name;
  run.seed = scenario.seed;
  run.world = scenario.world;
  run.origin = simulation.origin();
  run.camera = intrinsics(simulation.calibration().camera);
  run.objects = simulation.objects();
  return run;
}

void run_detector(Detector& detector, const cv::Mat3b& image, const cv::Mat1b& grey,
                  recording::FrameRecord& frame) {
  double step_ms = 0;
  const auto step = [&]() -> const FrameResult& {
    return detector.step({image, grey, frame.corners_px, frame.motion, frame.signatures,
                          frame.index, frame.t_ns, frame.gaps ? &*frame.gaps : nullptr});
  };
  const bool is_process = detector.step_time() == &recording::FrameTimes::process_ms;
  const FrameResult& said =
      is_process ? timed<std::chrono::steady_clock>(step_ms, step) : timed(step_ms, step);
  store_result(said, detector.step_time(), step_ms, frame);
  frame.masks = detector.masks();
}

void for_each_frame(const std::function<std::optional<InputFrame>()>& make,
                    const std::function<void(InputFrame&)>& work, int threads) {
  if (threads == 1) {
    while (std::optional<InputFrame> seen = make()) work(*seen);
    return;
  }
  for (std::optional<InputFrame> seen = make(), next; seen; seen = std::move(next)) {
    std::future<void> worked = std::async(std::launch::async, work, std::ref(*seen));
    try {
      next = make();
    } catch (...) {
      worked.get();  // an error of the frame before comes first
      throw;
    }
    worked.get();
  }
}

RunEnd run(FrameSource& source, CornerFinder corners, std::span<const DetectorRun> detectors,
           int threads) {
  const bool are_signatures_wanted = std::ranges::any_of(
      detectors, [](const DetectorRun& each) { return each.detector.wants_signatures(); });

  const auto make = [&] { return next_input_frame(source, corners, are_signatures_wanted); };
  const auto work = [&](const InputFrame& seen) {
    for (const DetectorRun& each : detectors) {
      recording::FrameRecord frame = seen.record;
      if (!each.detector.wants_signatures()) {  // as in a run of its own
        frame.signatures = {};
        frame.times->describe_ms = 0;
      }
      run_detector(each.detector, seen.image, seen.grey, frame);
      each.sink(frame, seen.image);
    }
  };
  for_each_frame(make, work, threads);
  RunEnd end{.diagnostics = {}, .warnings = source.warnings()};
  for (const DetectorRun& each : detectors) {
    end.diagnostics.push_back(source.diagnostics());
    each.detector.finish();
    end.diagnostics.back() += each.detector.diagnostics();
  }
  return end;
}

RunEnd run(const scenario::Scenario& scenario, sim::Simulation& simulation,
           std::span<const DetectorRun> detectors, int threads) {
  SimulatedFrames frames(scenario, simulation);
  return run(frames, CornerFinder(scenario), detectors, threads);
}

std::vector<Eigen::Vector2f> CornerFinder::find(const cv::Mat1b& grey,
                                                std::span<const sim::Event> events) {
  if (!is_by_events_) return fast_.detect(grey);
  if (!events_) events_.emplace(grey.cols, grey.rows);
  for (const sim::Event& event : events) events_->add(event.x, event.y, event.t_ns, event.is_on);
  return events_->step();
}

std::optional<cv::Mat1b> CornerFinder::surface() const {
  if (!events_) return std::nullopt;
  return events_->arc_star().picture();
}

}  // namespace lcs::bench
