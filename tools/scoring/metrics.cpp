#include "tools/scoring/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/scoring/scores.h"
#include "tools/scoring/statistics.h"

namespace lcs::scoring {
namespace {

using Figure = std::optional<double>;

constexpr double kRelative = 0.05;  // for figures that are not shares

/// \name The sets of tables that have a metric.
///@{
constexpr std::array kInAll{Table::suite, Table::report, Table::worlds, Table::detectors};
constexpr std::array kInWorlds{Table::suite, Table::report, Table::worlds};
constexpr std::array kInSuites{Table::suite, Table::report};
constexpr std::array kInReport{Table::report}, kInDetectors{Table::detectors};
constexpr std::array kInMeasures{Table::report, Table::detectors};
///@}

constexpr Scale kShare{"", Direction::higher, 0.01, 0, 2};
constexpr Scale kLostShare{"", Direction::lower, 0.01, kRelative, 2};
constexpr Scale kCount{"", Direction::neutral, 0, kRelative, 0};
constexpr Scale lower(std::string_view unit, double least_change, int decimals) {
  return {unit, Direction::lower, least_change, kRelative, decimals};
}
constexpr Scale neutral(std::string_view unit, int decimals) {
  return {unit, Direction::neutral, 0, kRelative, decimals};
}

// ---- Rebels

/// Defined where recall and F1 are, so that means of the three are over the same scenarios.
Figure precision_of(const RebelCounts& counts) {
  return counts.recall() ? Figure(counts.precision().value_or(0)) : std::nullopt;
}

Figure lost_f1(const Scores& s, Difficulty difficulty) {
  const Figure without = s.corners.without[static_cast<std::size_t>(difficulty)].f1();
  const Figure f1 = s.corners.overall.f1();
  return without && f1 ? Figure(*without - *f1) : std::nullopt;
}

/// Undefined for a detector that never gives the reason `first_sighting`.
Figure lost_f1_by_sighting(const Scores& s, Difficulty difficulty) {
  return s.tells_first_sightings ? lost_f1(s, difficulty) : std::nullopt;
}

int counted_rebels(const RebelCounts& counts) {
  return counts.found_rebels + counts.missed_rebels;
}

/// Undefined for a detector without circles.
Figure ratio_of_circles(const Scores& s, double part, double whole) {
  return s.detector.circles ? ratio(part, whole) : std::nullopt;
}

std::vector<Metric> rebel_metrics() {
  return {
      {"rebel.precision", [](auto& s) { return precision_of(s.corners.overall); }, kShare,
       "precision",
       "true rebels / (true + false rebels). After the warm-up; null where recall is, as in static "
       "scenes, else 0 without a true rebel",
       kInWorlds},
      {"rebel.recall", [](auto& s) { return s.corners.overall.recall(); }, kShare, "recall",
       "share of the rebel corners with verdict rebel. Counted from frame k0 + N of their object "
       "on, whatever else the verdict is",
       kInAll},
      {"rebel.f1", [](auto& s) { return s.corners.overall.f1(); }, kShare, "F1",
       "harmonic mean of precision and recall. 0 where recall is 0, null where recall is", kInAll},
      {"rebel.precision_distinct", [](auto& s) { return precision_of(s.corners.distinct); }, kShare,
       "", "precision without radial corners"},
      {"rebel.recall_distinct", [](auto& s) { return s.corners.distinct.recall(); }, kShare, "",
       "recall without radial corners"},
      {"rebel.f1_distinct", [](auto& s) { return s.corners.distinct.f1(); }, kShare, "F1 dist.",
       "F1 without radial corners, which move as nearer static ones would", kInSuites},
      {"rebel.precision_clear", [](auto& s) { return precision_of(s.corners.clear); }, kShare, "",
       "precision without corners at outlines. Recall is the same, as no rebel is at an outline"},
      {"rebel.f1_clear", [](auto& s) { return s.corners.clear.f1(); }, kShare, "F1 clear",
       "F1 without the fixed corners at outlines of movers. Its distance from 1 is what better "
       "separation of motions can gain",
       kInReport},
      {"rebel.recall_radial", [](auto& s) { return s.corners.radial.recall(); }, kShare,
       "radial recall", "recall over radial corners alone"},
      {"rebel.f1_lost_outline", [](auto& s) { return lost_f1(s, Difficulty::outline); }, kLostShare,
       "at outlines", "gain of F1 if all verdicts on corners at outlines were right"},
      {"rebel.f1_lost_radial", [](auto& s) { return lost_f1(s, Difficulty::radial); }, kLostShare,
       "on radial corners", "gain of F1 if all verdicts on radial corners were right"},
      {"rebel.f1_lost_first_seen",
       [](auto& s) { return lost_f1_by_sighting(s, Difficulty::first_seen); }, kLostShare,
       "on corners seen first",
       "gain of F1 if all verdicts on corners seen for the first time were right. By the reasons "
       "first_sighting and inherited; null for detectors without these"},
      {"rebel.f1_lost_tracked", [](auto& s) { return lost_f1_by_sighting(s, Difficulty::tracked); },
       kLostShare, "on others",
       "gain of F1 if all verdicts on other corners were right. null likewise"},
      {"rebel.false_corners_per_frame",
       [](auto& s) { return ratio(s.corners.overall.false_rebels, s.objects.frames); },
       lower("per frame", 0.1, 1), "false corners",
       "false rebels. For static scenes, which have no precision", kInAll},
      {"rebel.object_recall", [](auto& s) { return ratio(s.objects.found, s.objects.objects); },
       kShare, "found",
       "share of the movers that are found. A mover is found if 3 or more of its corners are "
       "rebels in a frame from k0 on. Of movers with rebel corners in at least N frames",
       kInWorlds},
      {"rebel.latency_frames_median", [](auto& s) { return median(s.objects.latencies); },
       lower("frames", 0.4, 1),
       "latency",  // a median may be half-integer
       "frames from k0 of a mover until it is found. Median over those found: 2 or more by the "
       "paper's rule, which needs N sightings; 0 or 1 are possible by the default",
       kInSuites},
      {"rebel.latency_ms_median", [](auto& s) { return median(s.objects.latencies_ms); },
       lower("ms", 20, 0), "corner latency", "rebel.latency_frames_median as time"},
      {"rebel.average_precision", [](auto& s) { return s.movers.corner_precision; }, kShare,
       "corner AP",
       "average precision of corners by falling log odds. As COCO's, over the corners that recall "
       "counts and the fixed ones; null for detectors without log odds",
       kInReport},
      {"rebel.false_objects_per_100_frames",
       [](auto& s) {
         return ratio_of_circles(s, 100.0 * s.objects.false_circles, s.objects.frames);
       },
       lower("per 100 frames", 1, 1), "false",
       "rebel circles with no mover under them. There is no corner of one in the disc, no box "
       "round the centre",
       kInAll},
      {"rebel.circle_recall",
       [](auto& s) { return ratio_of_circles(s, s.objects.circled, s.objects.seen); }, kShare, "",
       "share of the movers with 3 or more rebel corners that have the centre of a rebel circle in "
       "their box. Falls where a detector gives fewer circles to avoid false objects"},
      {"truth.rebel_corners", [](auto& s) { return counted_rebels(s.corners.overall); }, kCount, "",
       "rebel corners that recall counts"},
      {"truth.radial_corners", [](auto& s) { return counted_rebels(s.corners.radial); }, kCount, "",
       "radial corners that recall counts"},
      {"truth.fixed_corners", [](auto& s) { return s.corners.fixed_corners; }, kCount, "",
       "corners labelled fixed"},
      {"truth.rebel_objects", [](auto& s) { return s.objects.objects; }, kCount, "movers",
       "movers that rebel.object_recall counts"},
  };
}

// ---- Squares

Figure mean_iou(const SquareScore& squares) {
  std::vector<double> all = squares.movers_iou;
  all.insert(all.end(), squares.static_iou.begin(), squares.static_iou.end());
  return mean(all);
}

std::vector<Metric> square_metrics() {
  const std::string boxed = "right squares / eligible boxes, at the IoU in the key (%)";
  const std::string right = "right / (right + wrong) squares, at the IoU in the key (%)";
  return {
      {"square.recall_30", [](auto& s) { return s.squares.at_30.recall(); }, kShare, "", boxed},
      {"square.recall_50", [](auto& s) { return s.squares.at_50.recall(); }, kShare, "boxed", boxed,
       kInWorlds},
      {"square.recall_70", [](auto& s) { return s.squares.at_70.recall(); }, kShare, "", boxed},
      {"square.precision_30", [](auto& s) { return s.squares.at_30.precision(); }, kShare, "",
       right},
      {"square.precision_50", [](auto& s) { return s.squares.at_50.precision(); }, kShare,
       "sq prec.", right, kInSuites},
      {"square.precision_70", [](auto& s) { return s.squares.at_70.precision(); }, kShare, "",
       right},
      {"square.recall_50_movers", [](auto& s) { return s.squares.movers_50.recall(); }, kShare,
       "boxed movers", "square.recall_50 over objects that move at any time in the run",
       kInDetectors},
      {"square.recall_50_static", [](auto& s) { return s.squares.static_50.recall(); }, kShare,
       "boxed static", "square.recall_50 over objects that never move"},
      {"square.mean_iou", [](auto& s) { return mean_iou(s.squares); }, kShare, "IoU",
       "mean IoU of the pairs matched at 0.5"},
      {"square.mean_iou_movers", [](auto& s) { return mean(s.squares.movers_iou); }, kShare, "",
       "square.mean_iou over objects that move at any time in the run"},
      {"square.mean_iou_static", [](auto& s) { return mean(s.squares.static_iou); }, kShare, "",
       "square.mean_iou over objects that never move"},
      {"square.identity_switches",
       [](auto& s) {
         return s.squares.at_50.boxes > 0 ? Figure(s.squares.identity_switches) : std::nullopt;
       },
       lower("", 0.9, 0), "",
       "times that an object's square at 0.5 has another id than its last one"},
      {"truth.boxes", [](auto& s) { return s.squares.at_50.boxes; }, kCount, "",
       "eligible boxes, over all frames"},
      {"truth.objects", [](auto& s) { return static_cast<double>(s.objects_seen.size()); }, kCount,
       "", "objects seen in at least one frame"},
  };
}

// ---- Movers, by the measures of the literature

Figure track(const Scores& s, double TrackMeasures::*measure) {
  return s.movers.tracks ? Figure((*s.movers.tracks).*measure) : std::nullopt;
}

std::vector<Metric> mover_metrics() {
  return {
      {"mover.hota", [](auto& s) { return track(s, &TrackMeasures::hota); }, kShare, "HOTA",
       "HOTA of the moving squares (Luiten et al. 2021). Boxes are the eligible ones of objects "
       "that move in the frame; squares on other boxes of movers are left out, as MOTChallenge "
       "leaves out those on distractors",
       kInMeasures},
      {"mover.hota_detection", [](auto& s) { return track(s, &TrackMeasures::detection); }, kShare,
       "", "DetA of mover.hota"},
      {"mover.hota_association", [](auto& s) { return track(s, &TrackMeasures::association); },
       kShare, "", "AssA of mover.hota"},
      {"mover.mota", [](auto& s) { return track(s, &TrackMeasures::mota); }, kShare, "MOTA",
       "MOTA at IoU 0.5 of the same boxes (Bernardin and Stiefelhagen 2008). Below 0 with more "
       "faults than boxes"},
      {"mover.idf1", [](auto& s) { return track(s, &TrackMeasures::idf1); }, kShare, "IDF1",
       "IDF1 at IoU 0.5 of the same boxes (Ristani et al. 2016)", kInReport},
      {"mover.identity_changes",
       [](auto& s) {
         return s.movers.tracks ? Figure(s.movers.tracks->identity_changes) : std::nullopt;
       },
       lower("", 0.9, 0), "", "IDSW of MOTA"},
      {"mover.average_precision", [](auto& s) { return s.movers.box_precision; }, kShare, "box AP",
       "AP at IoU 0.5 of the same boxes (COCO). By the mean log odds of a square's rebel corners; "
       "null for detectors without log odds",
       kInReport},
      {"mover.detection_rate", [](auto& s) { return ratio(s.movers.detected, s.movers.boxes); },
       kShare, "detected",
       "share of the same boxes that are detected by the rule of event cameras' papers (Mitrokhin "
       "et "
       "al. 2018). A square covers over half of the box, and more of it than of its surroundings",
       kInMeasures},
      {"mover.region_j", [](auto& s) { return mean(s.movers.region_j); }, kShare, "",
       "J: IoU of the moving pixels with those of the moving squares' masks, outlines or boxes. "
       "Mean over frames with moving pixels (Perazzi et al. 2016)"},
      {"mover.boundary_f", [](auto& s) { return mean(s.movers.boundary_f); }, kShare, "",
       "F of the boundaries of the same pixels, within .008 of the picture's diagonal. Mean "
       "likewise"},
      {"mover.j_and_f",
       [](auto& s) {
         const Figure j = mean(s.movers.region_j), f = mean(s.movers.boundary_f);
         return j && f ? Figure((*j + *f) / 2) : std::nullopt;
       },
       kShare, "J&F", "mean of mover.region_j and mover.boundary_f", kInMeasures},
      {"mover.pixel_iou", [](auto& s) { return ratio(s.movers.common_px, s.movers.all_px); },
       kShare, "", "IoU of the same pixels of all frames together"},
      {"mover.latency_ms_median", [](auto& s) { return median(s.movers.latencies_ms); },
       lower("ms", 20, 0), "box latency",
       "time from the first frame in which a corner of an object moves by 1 px until a moving "
       "square has an IoU of 0.5 with it. Median over the objects boxed, of movers with rebel "
       "corners in at least N frames",
       kInMeasures},
      {"mover.false_per_minute",
       [](auto& s) { return ratio(60.0 * s.movers.false_tracks, s.movers.still_s); },
       lower("per minute", 1, 1), "",
       "moving squares in frames in which no object moves, each id once. Per minute of such "
       "frames"},
  };
}

// ---- Labels

/// Undefined if no frame is labelled.
Figure label_count(const Scores& s, int count) {
  return s.labels.frames > 0 ? Figure(count) : std::nullopt;
}

std::vector<Metric> label_metrics() {
  return {
      {"labels.frames", [](auto& s) { return label_count(s, s.labels.frames); }, kCount, "frames",
       "labelled frames. null where nothing is labelled"},
      {"labels.boxes", [](auto& s) { return label_count(s, s.labels.boxes); }, kCount, "boxes",
       "boxes in the labelled frames. null where nothing is labelled"},
      {"labels.found", [](auto& s) { return ratio(s.labels.found, s.labels.boxes); }, kShare,
       "found", "share of the labelled boxes with at least 3 rebel corners in them"},
      {"labels.boxed_50", [](auto& s) { return ratio(s.labels.boxed, s.labels.boxes); }, kShare,
       "boxed",
       "share of the labelled boxes that a moving square covers with an IoU of 0.5, one to one. A "
       "square moves if a circle of it is rebel, or if it has none, as of a body that moved "
       "before; by detectors other than the filter every square does"},
      {"labels.rebels_off_per_frame",
       [](auto& s) { return ratio(s.labels.rebels_off, s.labels.frames); },
       lower("per frame", 0.1, 1), "rebels off", "rebel corners in no labelled box"},
      {"labels.circles_off_per_100_frames",
       [](auto& s) { return ratio_of_circles(s, 100.0 * s.labels.circles_off, s.labels.frames); },
       lower("per 100 frames", 1, 1), "circles off",
       "rebel circles with no labelled box under them. There is no corner in a box in the disc, no "
       "box round the centre"},
  };
}

// ---- Findings, right or wrong

std::vector<Metric> found_metrics() {
  return {
      {"found.rebels_per_frame", [](auto& s) { return ratio(s.rebels_found, s.frames); },
       neutral("per frame", 1), "rebels",
       "corners that the detector calls rebels, right or wrong. Mean over frames"},
      {"found.movers_per_frame", [](auto& s) { return ratio(s.movers_found, s.frames); },
       neutral("per frame", 2), "movers", "squares that move, right or wrong. Mean over frames"},
  };
}

// ---- Sizes, ego-motion

/// For each frame, the number of corners in the last `length` frames including itself.
std::vector<double> store_sizes(const Scores& s, std::size_t length) {
  std::vector<double> sizes;
  double size = 0;
  for (std::size_t k = 0; k < s.corner_counts.size(); ++k) {
    size += s.corner_counts[k];
    if (k >= length) size -= s.corner_counts[k - length];
    sizes.push_back(size);
  }
  return sizes;
}

std::vector<double> all_corners(const Scores& s) {
  return store_sizes(s, s.corner_counts.size());
}

std::vector<Metric> other_metrics() {
  return {
      {"dimension.corners_mean", [](auto& s) { return mean(s.corner_counts); }, kCount, "corners",
       "corners of a frame, ignored ones included. Mean over frames"},
      {"dimension.mean", [](auto& s) { return mean(s.dimensions); }, lower("", 1, 0), "items",
       "edges, circles and squares of a frame, the paper's dimensionality. Mean over frames"},
      {"dimension.max", [](auto& s) { return quantile(s.dimensions, 1); }, lower("", 1, 0), "",
       "greatest number of edges, circles and squares in a frame"},
      {"dimension.five_frame_mean", [](auto& s) { return mean(store_sizes(s, 5)); }, kCount,
       "5-frame store",
       "corners of the last 5 frames together, the current one included. Mean over frames"},
      {"dimension.eight_frame_mean", [](auto& s) { return mean(store_sizes(s, 8)); }, kCount,
       "8-frame store",
       "corners of the last 8 frames together, the current one included. Mean over frames"},
      {"dimension.accumulative", [](auto& s) { return mean(all_corners(s)); }, kCount, "",
       "corners of all frames so far. Mean over frames"},
      {"dimension.accumulative_final", [](auto& s) { return quantile(all_corners(s), 1); }, kCount,
       "full store", "corners of all frames"},
      {"edges.rematched", [](auto& s) { return ratio(s.rematched_edges, s.edges); }, kShare, "",
       "share of the normal edges of a frame that have a corner in the next one. The others may "
       "lie inside psi then, or have left the image"},
      {"ego.rotation_error_mrad_median", [](auto& s) { return median(s.rotation_errors_mrad); },
       lower("mrad", 0.01, 2), "",
       "angle between the told and the true rotation since the last frame. Median over frames"},
      {"ego.velocity_error_mps_median", [](auto& s) { return median(s.velocity_errors_mps); },
       lower("m/s", 0.001, 3), "",
       "distance between the told and the true mean velocity over a frame. Median over frames"},
  };
}

// ---- Times

/// The stage's times over the frames, in ms; empty if the stage took no time in any frame.
std::vector<double> times_of(const Scores& s, const Stage& stage) {
  std::vector<double> times;
  if (stage.is_layer && !s.detector.layered) return times;
  for (const recording::FrameTimes& frame : s.times) times.push_back(frame.*stage.time_ms);
  const bool was_done = std::ranges::any_of(times, [](double ms) { return ms > 0; });
  return was_done ? times : std::vector<double>{};
}

Figure over_fast(const Scores& s, const Stage& stage) {
  const std::vector<double> times = times_of(s, stage);
  const std::vector<double> fast = times_of(s, kStages[0]);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(times.size(), fast.size()); ++i) {
    if (fast[i] > 0) ratios.push_back(times[i] / fast[i]);
  }
  return median(ratios);
}

Figure frames_per_second(const Scores& s) {
  double seconds = 0;
  for (const recording::FrameTimes& times : s.times) {
    seconds += 1e-3 * (times.simulate_ms + times.detect_ms + times.describe_ms + times.filter_ms +
                       times.process_ms + times.truth_ms);
  }
  return ratio(s.times.size(), seconds);
}

/// Metrics of times. They are neutral, because times differ between machines and runs.
std::vector<Metric> time_metrics() {
  std::vector<Metric> all;
  for (const Stage& stage : kStages) {
    const std::string key = std::string("time.") + stage.name, label = stage.label;
    const bool in_detectors = key == "time.filter" || key == "time.process";
    all.push_back({key + "_ms_median", [stage](auto& s) { return median(times_of(s, stage)); },
                   neutral("ms", 1), label, "median over frames of the stage's time",
                   in_detectors ? kInDetectors : std::span<const Table>()});
    all.push_back({key + "_ms_p99", [stage](auto& s) { return quantile(times_of(s, stage), 0.99); },
                   neutral("ms", 1), label.empty() ? "" : label + " p99",
                   "99th percentile over frames of the stage's time"});
    if (!stage.is_of_filter) continue;
    all.push_back({key + "_over_fast", [stage](auto& s) { return over_fast(s, stage); },
                   neutral("", 1), label == "filter" ? "time" : "",
                   "the stage's time over FAST's time in the same frame. Median over frames",
                   label == "filter" ? kInSuites : std::span<const Table>()});
  }
  all.push_back(
      {"sim.frames_per_second", frames_per_second, neutral("frames/s", 1), "",
       "speed of simulate, detect, describe, filter or process, and truth. Without writing files"});
  return all;
}

// ---- Warnings

/// Metrics of warnings. They are neutral, because warnings do not concern the detector.
std::vector<Metric> warning_metrics() {
  const std::pair<std::string, std::string> rows[] = {
      {"rover_below_ground",
       "times that the rover's origin came over 0.1 m below the floor (a plane that faces up, a "
       "height field), or without one below all of the setting"},
      {"rover_tipped", "times that the rover came to lean by over 45 deg"},
      {"rover_collisions",
       "objects, actors and geoms of the setting that were inside of the rover by over 2 cm, or "
       "that its wheels pushed sideways. Each counts once a run"},
      {"actor_collisions",
       "pairs of an actor and another actor, an object or a geom of the setting, inside of each "
       "other by over 2 cm. Each counts once a run; actors step over fixed geoms that end lower "
       "than 0.2 m above their feet"},
      {"objects_below_ground",
       "times that the middle of an object with a joint fell over 0.1 m below the ground"},
      {"rover_off_command",
       "seconds in which the rover's mean velocity differed from its command by over 20 % and 0.05 "
       "m/s, or its mean yaw rate by over 20 % and 2 deg/s, on height fields 10 deg/s"},
      {"actors_never_moved",
       "actors with a trajectory that did not move until the last frame: their start trigger did "
       "not fire, or their speed is 0"},
      {"actors_never_seen", "actors without a visible pixel in any frame"},
      {"actors_in_ground",
       "times that the lowest point of an actor came over 0.1 m below the ground"},
      {"actors_of_other_size",
       "actors whose visible geoms are larger or smaller than their stated size by over a quarter, "
       "along any axis"},
      {"translucent_geoms",
       "geoms with an alpha between 0 and 1. They are drawn opaque (scenes/README.md)"},
      {"undrawn_parts",
       "skins, tendons, flexes and large sites, which are not drawn (scenes/README.md)"},
      {"joints_frozen", "actors, scene or rover that keep a pose, and whose joints do not move"},
      {"options_replaced", "options of the scene that are replaced (scenes/README.md)"},
      {"mujoco_warnings", "warnings of MuJoCo's own, of the scene, its models and its physics"},
      {"joints_loose", "joints of the rover that have a motor and are neither driven nor posed"},
      {"bodies_named", "bodies of the scene that move and had no name"},
      {"coplanar_faces", "pairs of geoms that have faces in one plane and differ"},
      {"coarse_shutter",
       "frames that shift by more than 0.5 px between two of their 64 drawings "
       "(sim/base/shutter.h)"},
      {"coarse_events",
       "frames until which the picture shifts by more than 1 px between two of the 128 instants at "
       "which events are sampled (sim/events/event_sensor.h)"},
      {"few_corners", "frames with fewer than 10 corners; 0 if not more than half"},
      {"runaway_speed", "frames with a told speed above 70 m/s. Of recordings alone"},
      {"turn_not_told",
       "frames in which most corners moved by the same vector of 3 px or more, without a told turn "
       "or motion to the side; 0 if fewer than five. Of recordings alone"},
      {"still_camera",
       "times that nearly all corners stayed in place over 1 m of told motion; 0 if fewer than "
       "three, or than nine in ten. Of recordings alone"},
      {"many_rebels",
       "frames after the warm-up with 30 % rebels or more; 0 if not more than half. Of recordings "
       "alone"},
  };
  std::vector<Metric> all;
  for (const auto& [word, meaning] : rows) {
    const auto count = [word = word](const Scores& s) {
      return Figure(std::ranges::find(s.warnings, word, &recording::Warned::word)->count);
    };
    all.push_back({"warnings." + word, count, kCount, "", meaning});
  }
  return all;
}

}  // namespace

const std::vector<Metric>& metrics() {
  static const std::vector<Metric> all = [] {
    std::vector<Metric> table;
    const auto add = [&](std::vector<Metric> rows,
                         recording::Truth needs = recording::Truth::unknown) {
      for (Metric& row : rows) {
        row.needs = needs;
        table.push_back(std::move(row));
      }
    };
    add({{"frames", [](auto& s) { return static_cast<double>(s.frames); }, kCount, "frames",
          "frames of the recording"}});
    add(rebel_metrics(), recording::Truth::nothing_moves);
    add(square_metrics(), recording::Truth::all);
    add(mover_metrics(), recording::Truth::all);
    add(label_metrics());
    add(found_metrics());
    add(other_metrics());
    add(time_metrics());
    add(warning_metrics());
    add({{std::string(kSizeShare), nullptr, kLostShare, "size",
          "dimension.mean / dimension.five_frame_mean. In suites and comparisons, not in "
          "metrics.json",
          kInSuites}});
    return table;
  }();
  return all;
}

std::vector<std::string_view> keys_in(Table table) {
  std::vector<std::string_view> keys;
  for (const Metric& metric : metrics()) {
    if (std::ranges::find(metric.shown, table) != metric.shown.end()) keys.push_back(metric.key);
  }
  return keys;
}

const Metric& metric(std::string_view key) {
  const auto found = std::ranges::find(metrics(), key, &Metric::key);
  if (found == metrics().end()) throw std::out_of_range(fmt::format("no metric is called {}", key));
  return *found;
}

std::string Metric::number(std::optional<double> value) const {
  if (!value) return "-";
  // times have three significant digits
  const int digits = scale.unit != "ms" ? scale.decimals : *value < 10 ? 2 : *value < 100 ? 1 : 0;
  return fmt::format("{:.{}f}", *value, digits);
}

std::string Metric::heading() const {
  return scale.unit.empty() ? label : fmt::format("{} ({})", label, scale.unit);
}

std::string_view Metric::first_sentence() const {
  return std::string_view(meaning).substr(0, meaning.find(". "));
}

double least_change(const Scale& scale, double before) {
  return std::max(scale.least_change, scale.least_share * std::abs(before));
}

int sign_of_change(Direction better, double before, double after) {
  if (better == Direction::neutral || before == after) return 0;
  return (after > before) == (better == Direction::higher) ? 1 : -1;
}

}  // namespace lcs::scoring
