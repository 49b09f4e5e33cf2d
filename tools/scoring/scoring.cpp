#include "tools/scoring/scoring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "tools/scoring/metrics.h"
#include "tools/scoring/scores.h"
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
  const double p = precision().value();  // defined, because recall > 0 implies a TP
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

Scores::Scores(const Recording& of)
    : recording(of),
      objects(score_rebel_objects(of)),
      squares(score_squares(of)),
      labels(score_labels(of)),
      warnings(warnings_of(of)) {
  for (const RebelCornerScore& frame : score_rebel_corners(of)) corners += frame;
  for (const FrameRecord& frame : of.frames) {
    corner_counts.push_back(static_cast<double>(frame.corners_px.size()));
    if (of.detector.layered) dimensions.push_back(static_cast<double>(frame.layers.dimension()));
    if (frame.true_motion.dt_s <= 0) continue;
    const Eigen::AngleAxisd error(frame.motion.R_cur_prev.transpose() *
                                  frame.true_motion.R_cur_prev);
    rotation_errors_mrad.push_back(1000 * error.angle());
    velocity_errors_mps.push_back((frame.motion.v_C_mps - frame.true_motion.v_C_mps).norm());
  }
}

Metrics score(const Recording& recording) {
  require_pairs(recording);
  const Scores scores(recording);
  Metrics figures;
  for (const Metric& metric : metrics()) {
    if (!metric.compute) continue;
    const bool is_known = recording.truth <= metric.needs;
    figures.emplace_back(metric.key, is_known ? metric.compute(scores) : std::nullopt);
  }
  return figures;
}

std::optional<double> value(const Metrics& metrics, const std::string& name) {
  const auto found = std::find_if(metrics.begin(), metrics.end(),
                                  [&](const auto& metric) { return metric.first == name; });
  if (found == metrics.end()) throw std::out_of_range("no metric is called " + name);
  return found->second;
}

}  // namespace lcs::bench
