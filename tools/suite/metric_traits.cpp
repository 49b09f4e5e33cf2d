#include "tools/suite/metric_traits.h"

#include <algorithm>
#include <cmath>

namespace lcs::suite {
namespace {

constexpr double kShare = 0.01;     // of precision, recall and their like: one in a hundred
constexpr double kRelative = 0.05;  // of figures without a scale of their own

constexpr MetricTraits higher_share(std::string_view name) {
  return {name, Direction::higher, kShare, 0};
}
constexpr MetricTraits lower(std::string_view name, double least_change) {
  return {name, Direction::lower, least_change, kRelative};
}
constexpr MetricTraits neutral(std::string_view name) {
  return {name, Direction::neutral, 0, kRelative};
}

}  // namespace

const std::vector<MetricTraits>& metric_traits() {
  static const std::vector<MetricTraits> all{
      neutral("frames"),
      higher_share("rebel.precision"),
      higher_share("rebel.recall"),
      higher_share("rebel.f1"),
      higher_share("rebel.precision_distinct"),
      higher_share("rebel.recall_distinct"),
      higher_share("rebel.f1_distinct"),
      higher_share("rebel.precision_clear"),
      higher_share("rebel.f1_clear"),
      higher_share("rebel.recall_radial"),
      lower("rebel.f1_lost_outline", kShare),
      lower("rebel.f1_lost_radial", kShare),
      lower("rebel.f1_lost_first_seen", kShare),
      lower("rebel.f1_lost_tracked", kShare),
      lower("rebel.false_corners_per_frame", 0.1),
      higher_share("rebel.object_recall"),
      lower("rebel.latency_frames_median", 0.4),  // of an even number of objects it has halves
      lower("rebel.false_objects_per_100_frames", 1),
      higher_share("rebel.circle_recall"),
      neutral("truth.rebel_corners"),
      neutral("truth.radial_corners"),
      neutral("truth.fixed_corners"),
      neutral("truth.rebel_objects"),
      higher_share("square.recall_30"),
      higher_share("square.recall_50"),
      higher_share("square.recall_70"),
      higher_share("square.precision_30"),
      higher_share("square.precision_50"),
      higher_share("square.precision_70"),
      higher_share("square.recall_50_movers"),
      higher_share("square.recall_50_static"),
      higher_share("square.mean_iou"),
      higher_share("square.mean_iou_movers"),
      higher_share("square.mean_iou_static"),
      lower("square.identity_switches", 0.9),  // counts whole ones
      higher_share("square.mask_recall_50"),
      higher_share("square.mask_precision_50"),
      higher_share("square.mask_mean_iou"),
      higher_share("square.mask_mean_iou_movers"),
      higher_share("square.mask_mean_iou_static"),
      neutral("truth.boxes"),
      neutral("truth.objects"),
      neutral("labels.frames"),
      neutral("labels.boxes"),
      higher_share("labels.found"),
      higher_share("labels.boxed_50"),
      lower("labels.rebels_off_per_frame", 0.1),
      lower("labels.circles_off_per_100_frames", 1),
      neutral("dimension.corners_mean"),
      lower("dimension.mean", 1),
      lower("dimension.max", 1),
      neutral("dimension.five_frame_mean"),
      neutral("dimension.eight_frame_mean"),
      neutral("dimension.accumulative"),
      neutral("dimension.accumulative_final"),
      higher_share("edges.rematched"),
      lower("ego.rotation_error_mrad_median", 0.01),
      lower("ego.velocity_error_mps_median", 0.001),
      // Times differ from run to run and machine to machine: told, never judged.
      neutral("time.detect_ms_median"),
      neutral("time.detect_ms_p99"),
      neutral("time.describe_ms_median"),
      neutral("time.describe_ms_p99"),
      neutral("time.line_ms_median"),
      neutral("time.line_ms_p99"),
      neutral("time.line_over_fast"),
      neutral("time.circle_ms_median"),
      neutral("time.circle_ms_p99"),
      neutral("time.circle_over_fast"),
      neutral("time.square_ms_median"),
      neutral("time.square_ms_p99"),
      neutral("time.square_over_fast"),
      neutral("time.filter_ms_median"),
      neutral("time.filter_ms_p99"),
      neutral("time.filter_over_fast"),
      neutral("time.process_ms_median"),
      neutral("time.process_ms_p99"),
      neutral("time.simulate_ms_median"),
      neutral("time.simulate_ms_p99"),
      neutral("time.truth_ms_median"),
      neutral("time.truth_ms_p99"),
      neutral("sim.frames_per_second"),
      // Of the world, not of who watches it.
      neutral("warnings.rover_below_ground"),
      neutral("warnings.rover_tipped"),
      neutral("warnings.rover_collisions"),
      neutral("warnings.actor_collisions"),
      neutral("warnings.objects_below_ground"),
      neutral("warnings.few_corners"),
      neutral("warnings.runaway_speed"),
      neutral("warnings.turn_not_told"),
      neutral("warnings.still_camera"),
      neutral("warnings.many_rebels"),
  };
  return all;
}

MetricTraits traits_of(std::string_view metric) {
  if (metric == kSizeShare) return {kSizeShare, Direction::lower, kShare, kRelative};
  const std::vector<MetricTraits>& all = metric_traits();
  const auto found = std::find_if(
      all.begin(), all.end(), [&](const MetricTraits& traits) { return traits.name == metric; });
  return found != all.end() ? *found : neutral(metric);
}

double least_change(const MetricTraits& traits, double before) {
  return std::max(traits.least_change, traits.least_share * std::abs(before));
}

int sign_of_change(Direction direction, double before, double after) {
  if (direction == Direction::neutral || before == after) return 0;
  return (after > before) == (direction == Direction::higher) ? 1 : -1;
}

}  // namespace lcs::suite
