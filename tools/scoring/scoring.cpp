#include "tools/scoring/scoring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <stdexcept>

#include "tools/recording/warnings.h"
#include "tools/scoring/score_labels.h"
#include "tools/scoring/score_rebels.h"
#include "tools/scoring/score_squares.h"
#include "tools/scoring/statistics.h"

namespace lcs::bench {
namespace {

void require_pairs(const Recording& recording) {
  for (const FrameRecord& frame : recording.frames) {
    const std::size_t corners = frame.corners_px.size();
    if (frame.verdicts.size() == corners && frame.corner_truth.size() == corners) continue;
    throw std::invalid_argument("frame " + std::to_string(frame.index) + " has " +
                                std::to_string(corners) + " corners, " +
                                std::to_string(frame.verdicts.size()) + " verdicts and " +
                                std::to_string(frame.corner_truth.size()) + " truths");
  }
}

void add_rebels(Metrics& metrics, const Recording& recording) {
  RebelCornerScore corners;
  for (const RebelCornerScore& frame : score_rebel_corners(recording)) corners += frame;
  const RebelObjectScore objects = score_rebel_objects(recording);

  metrics.emplace_back("rebel.precision", corners.overall.precision());
  metrics.emplace_back("rebel.recall", corners.overall.recall());
  metrics.emplace_back("rebel.f1", corners.overall.f1());
  metrics.emplace_back("rebel.precision_distinct", corners.distinct.precision());
  metrics.emplace_back("rebel.recall_distinct", corners.distinct.recall());
  metrics.emplace_back("rebel.f1_distinct", corners.distinct.f1());
  metrics.emplace_back("rebel.precision_clear", corners.clear.precision());
  metrics.emplace_back("rebel.f1_clear", corners.clear.f1());
  metrics.emplace_back("rebel.recall_radial", corners.radial.recall());
  const auto lost = [&](Difficulty difficulty) -> std::optional<double> {
    const std::optional<double> without =
        corners.without[static_cast<std::size_t>(difficulty)].f1();
    const std::optional<double> f1 = corners.overall.f1();
    return without && f1 ? std::optional(*without - *f1) : std::nullopt;
  };
  const bool tells_first = std::ranges::any_of(recording.frames, [](const FrameRecord& frame) {
    return std::ranges::count(frame.reasons, Reason::first_sighting) > 0;
  });
  metrics.emplace_back("rebel.f1_lost_outline", lost(Difficulty::outline));
  metrics.emplace_back("rebel.f1_lost_radial", lost(Difficulty::radial));
  metrics.emplace_back("rebel.f1_lost_first_seen",
                       tells_first ? lost(Difficulty::first_seen) : std::nullopt);
  metrics.emplace_back("rebel.f1_lost_tracked",
                       tells_first ? lost(Difficulty::tracked) : std::nullopt);
  metrics.emplace_back("rebel.false_corners_per_frame",
                       ratio(corners.overall.false_rebels, objects.frames));
  metrics.emplace_back("rebel.object_recall", ratio(objects.found, objects.objects));
  metrics.emplace_back("rebel.latency_frames_median", median(objects.latencies));
  const bool circles = recording.detector.circles;
  metrics.emplace_back(
      "rebel.false_objects_per_100_frames",
      circles ? ratio(100.0 * objects.false_circles, objects.frames) : std::nullopt);
  metrics.emplace_back("rebel.circle_recall",
                       circles ? ratio(objects.circled, objects.seen) : std::nullopt);

  const auto counted = [](const RebelCounts& counts) {
    return counts.found_rebels + counts.missed_rebels;
  };
  metrics.emplace_back("truth.rebel_corners", counted(corners.overall));
  metrics.emplace_back("truth.radial_corners", counted(corners.radial));
  metrics.emplace_back("truth.fixed_corners", corners.fixed_corners);
  metrics.emplace_back("truth.rebel_objects", objects.objects);
}

void add_squares(Metrics& metrics, const Recording& recording) {
  const SquareScore squares = score_squares(recording);
  std::vector<double> all_iou = squares.movers_iou;
  all_iou.insert(all_iou.end(), squares.static_iou.begin(), squares.static_iou.end());

  metrics.emplace_back("square.recall_30", squares.at_30.recall());
  metrics.emplace_back("square.recall_50", squares.at_50.recall());
  metrics.emplace_back("square.recall_70", squares.at_70.recall());
  metrics.emplace_back("square.precision_30", squares.at_30.precision());
  metrics.emplace_back("square.precision_50", squares.at_50.precision());
  metrics.emplace_back("square.precision_70", squares.at_70.precision());
  metrics.emplace_back("square.recall_50_movers", squares.movers_50.recall());
  metrics.emplace_back("square.recall_50_static", squares.static_50.recall());
  metrics.emplace_back("square.mean_iou", mean(all_iou));
  metrics.emplace_back("square.mean_iou_movers", mean(squares.movers_iou));
  metrics.emplace_back("square.mean_iou_static", mean(squares.static_iou));
  metrics.emplace_back(
      "square.identity_switches",
      squares.at_50.boxes > 0 ? std::optional<double>(squares.identity_switches) : std::nullopt);
  const SquareScore::Masks masks = squares.masks.value_or(SquareScore::Masks{});
  all_iou = masks.movers_iou;
  all_iou.insert(all_iou.end(), masks.static_iou.begin(), masks.static_iou.end());
  metrics.emplace_back("square.mask_recall_50", masks.at_50.recall());
  metrics.emplace_back("square.mask_precision_50", masks.at_50.precision());
  metrics.emplace_back("square.mask_mean_iou", mean(all_iou));
  metrics.emplace_back("square.mask_mean_iou_movers", mean(masks.movers_iou));
  metrics.emplace_back("square.mask_mean_iou_static", mean(masks.static_iou));
  metrics.emplace_back("truth.boxes", squares.at_50.boxes);

  std::set<int> seen;
  for (const FrameRecord& frame : recording.frames) {
    for (const sim::ObjectTruth& truth : frame.object_truth) seen.insert(truth.object);
  }
  metrics.emplace_back("truth.objects", static_cast<double>(seen.size()));
}

/// By what people labelled.
void add_labels(Metrics& metrics, const Recording& recording) {
  const LabelScore score = score_labels(recording);
  const auto count = [&](int number) {
    return score.frames > 0 ? std::optional<double>(number) : std::nullopt;
  };
  metrics.emplace_back("labels.frames", count(score.frames));
  metrics.emplace_back("labels.boxes", count(score.boxes));
  metrics.emplace_back("labels.found", ratio(score.found, score.boxes));
  metrics.emplace_back("labels.boxed_50", ratio(score.boxed, score.boxes));
  metrics.emplace_back("labels.rebels_off_per_frame", ratio(score.rebels_off, score.frames));
  metrics.emplace_back(
      "labels.circles_off_per_100_frames",
      recording.detector.circles ? ratio(100.0 * score.circles_off, score.frames) : std::nullopt);
}

/// Takes out figures of what is not known, those from `first` on.
void forget(Metrics& metrics, std::size_t first) {
  for (std::size_t i = first; i < metrics.size(); ++i) metrics[i].second.reset();
}

/// Corners in the last `length` frames, the current one included, at each frame.
std::vector<double> store_sizes(const std::vector<double>& corners, std::size_t length) {
  std::vector<double> sizes;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t first = k + 1 > length ? k + 1 - length : 0;
    double size = 0;
    for (std::size_t i = first; i <= k; ++i) size += corners[i];
    sizes.push_back(size);
  }
  return sizes;
}

void add_dimensions(Metrics& metrics, const Recording& recording) {
  std::vector<double> corners, dimensions;
  for (const FrameRecord& frame : recording.frames) {
    corners.push_back(static_cast<double>(frame.corners_px.size()));
    if (recording.detector.layered) {
      dimensions.push_back(static_cast<double>(frame.layers.dimension()));
    }
  }
  const std::vector<double> accumulated = store_sizes(corners, corners.size());

  metrics.emplace_back("dimension.corners_mean", mean(corners));
  metrics.emplace_back("dimension.mean", mean(dimensions));
  metrics.emplace_back("dimension.max", quantile(dimensions, 1));
  metrics.emplace_back("dimension.five_frame_mean", mean(store_sizes(corners, 5)));
  metrics.emplace_back("dimension.eight_frame_mean", mean(store_sizes(corners, 8)));
  metrics.emplace_back("dimension.accumulative", mean(accumulated));
  metrics.emplace_back("dimension.accumulative_final", quantile(accumulated, 1));
}

/// Of the normal edges of a frame, the share that has a corner in the next one.
void add_edges(Metrics& metrics, const Recording& recording) {
  double edges = 0, rematched = 0;
  const std::size_t end = recording.detector.layered ? recording.frames.size() : 0;
  for (std::size_t k = 1; k < end; ++k) {
    std::set<Id> supported;
    for (const Edge& edge : recording.frames[k].layers.normal_edges) {
      if (edge.corner >= 0) supported.insert(edge.id);
    }
    for (const Edge& edge : recording.frames[k - 1].layers.normal_edges) {
      edges += 1;
      rematched += static_cast<double>(supported.count(edge.id));
    }
  }
  metrics.emplace_back("edges.rematched", ratio(rematched, edges));
}

void add_ego_motion(Metrics& metrics, const Recording& recording) {
  std::vector<double> rotation_mrad, velocity_mps;
  for (const FrameRecord& frame : recording.frames) {
    if (frame.true_motion.dt_s <= 0) continue;
    const Eigen::AngleAxisd error(frame.motion.R_cur_prev.transpose() *
                                  frame.true_motion.R_cur_prev);
    rotation_mrad.push_back(1000 * error.angle());
    velocity_mps.push_back((frame.motion.v_C_mps - frame.true_motion.v_C_mps).norm());
  }
  metrics.emplace_back("ego.rotation_error_mrad_median", median(rotation_mrad));
  metrics.emplace_back("ego.velocity_error_mps_median", median(velocity_mps));
}

struct Stage {
  const char* name;
  double FrameTimes::*time_ms;
  bool of_layers = false;  ///< undefined for a detector without
};

void add_times(Metrics& metrics, const Recording& recording) {
  constexpr Stage kDetect{"detect", &FrameTimes::detect_ms};
  constexpr Stage kDescribe{"describe", &FrameTimes::describe_ms};
  constexpr Stage kStages[] = {{"line", &FrameTimes::line_ms, true},
                               {"circle", &FrameTimes::circle_ms, true},
                               {"square", &FrameTimes::square_ms, true},
                               {"filter", &FrameTimes::filter_ms}};
  constexpr Stage kBench[] = {{"process", &FrameTimes::process_ms},
                              {"simulate", &FrameTimes::simulate_ms},
                              {"truth", &FrameTimes::truth_ms}};

  const auto all = [&](const Stage& stage) {
    std::vector<double> times;
    if (stage.of_layers && !recording.detector.layered) return times;
    for (const FrameRecord& frame : recording.frames) {
      if (frame.times) times.push_back((*frame.times).*stage.time_ms);
    }
    const bool was_done = std::any_of(times.begin(), times.end(), [](double ms) { return ms > 0; });
    return was_done ? times : std::vector<double>{};
  };
  const auto add_quantiles = [&](const Stage& stage) {
    const std::string key = std::string("time.") + stage.name;
    const std::vector<double> times = all(stage);
    metrics.emplace_back(key + "_ms_median", median(times));
    metrics.emplace_back(key + "_ms_p99", quantile(times, 0.99));
  };
  const std::vector<double> fast = all(kDetect);

  add_quantiles(kDetect);
  add_quantiles(kDescribe);
  for (const Stage& stage : kStages) {
    add_quantiles(stage);
    const std::vector<double> times = all(stage);
    std::vector<double> over_fast;
    for (std::size_t i = 0; i < std::min(times.size(), fast.size()); ++i) {
      if (fast[i] > 0) over_fast.push_back(times[i] / fast[i]);
    }
    metrics.emplace_back(std::string("time.") + stage.name + "_over_fast", median(over_fast));
  }
  for (const Stage& stage : kBench) add_quantiles(stage);

  double seconds = 0;
  int timed = 0;
  for (const FrameRecord& frame : recording.frames) {
    if (!frame.times) continue;
    const FrameTimes& times = *frame.times;
    seconds += 1e-3 * (times.simulate_ms + times.detect_ms + times.describe_ms + times.filter_ms +
                       times.process_ms + times.truth_ms);
    ++timed;
  }
  metrics.emplace_back("sim.frames_per_second", ratio(timed, seconds));
}

}  // namespace

std::optional<double> RebelCounts::precision() const {
  return ratio(true_rebels, true_rebels + false_rebels);
}

std::optional<double> RebelCounts::recall() const {
  return ratio(found_rebels, found_rebels + missed_rebels);
}

std::optional<double> RebelCounts::f1() const {
  const std::optional<double> r = recall();
  if (!r || *r == 0) return r;
  const double p = precision().value();  // something was found, so something was said
  return 2 * p * *r / (p + *r);
}

RebelCounts& RebelCounts::operator+=(const RebelCounts& other) {
  true_rebels += other.true_rebels;
  false_rebels += other.false_rebels;
  found_rebels += other.found_rebels;
  missed_rebels += other.missed_rebels;
  return *this;
}

std::vector<RebelCounts> score_frames(const Recording& recording) {
  require_pairs(recording);
  std::vector<RebelCounts> counts;
  for (const RebelCornerScore& frame : score_rebel_corners(recording)) {
    counts.push_back(frame.overall);
  }
  return counts;
}

Metrics score(const Recording& recording) {
  require_pairs(recording);
  Metrics metrics;
  metrics.emplace_back("frames", static_cast<double>(recording.frames.size()));
  add_rebels(metrics, recording);
  if (recording.truth == Truth::unknown) forget(metrics, 1);
  const std::size_t rebels_end = metrics.size();
  add_squares(metrics, recording);
  if (recording.truth != Truth::all) forget(metrics, rebels_end);
  add_labels(metrics, recording);
  add_dimensions(metrics, recording);
  add_edges(metrics, recording);
  add_ego_motion(metrics, recording);
  add_times(metrics, recording);
  for (const Warned& warned : warnings_of(recording)) {
    metrics.emplace_back("warnings." + warned.word, warned.count);
  }
  return metrics;
}

std::optional<double> value(const Metrics& metrics, const std::string& name) {
  const auto found = std::find_if(metrics.begin(), metrics.end(),
                                  [&](const auto& metric) { return metric.first == name; });
  if (found == metrics.end()) throw std::out_of_range("no metric is called " + name);
  return found->second;
}

}  // namespace lcs::bench
