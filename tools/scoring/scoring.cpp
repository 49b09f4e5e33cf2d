#include "tools/scoring/scoring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <set>
#include <stdexcept>

#include "tools/recording/box.h"
#include "tools/scoring/metrics.h"
#include "tools/scoring/scores.h"

namespace lcs::scoring {
namespace {

void require_pairs(const recording::FrameRecord& frame) {
  const std::size_t corners = frame.corners_px.size();
  if (frame.verdicts.size() == corners && frame.corner_truth.size() == corners) return;
  throw std::invalid_argument("frame " + std::to_string(frame.index) + " has " +
                              std::to_string(corners) + " corners, " +
                              std::to_string(frame.verdicts.size()) + " verdicts and " +
                              std::to_string(frame.corner_truth.size()) + " truths");
}

constexpr double kMatch = 0.5;

/// A corner at an outline may lie this far outside of its object (FAST's circle), and labels by
/// hand are no more exact.
constexpr double kReach_px = 3;

struct Labelled {
  recording::Box box, reach;
  bool ignored;
};

std::vector<Labelled> labelled(const recording::FrameRecord& frame) {
  std::vector<Labelled> all;
  for (const recording::LabelledBox& label : *frame.labels) {
    const recording::Box box = recording::box_of(label);
    const Vec2 reach = Vec2::Constant(kReach_px);
    all.push_back({box, {box.min() - reach, box.max() + reach}, label.ignored});
  }
  return all;
}

bool in_any(const std::vector<Labelled>& labels, const Vec2& px) {
  return std::ranges::any_of(labels,
                             [&](const Labelled& label) { return label.reach.contains(px); });
}

std::vector<Vec2> rebel_corners(const recording::FrameRecord& frame) {
  std::vector<Vec2> corners;
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    if (frame.verdicts[i] == Verdict::rebel) corners.push_back(frame.corners_px[i].cast<double>());
  }
  return corners;
}

bool is_off(const Circle& circle, const recording::FrameRecord& frame,
            const std::vector<Labelled>& labels) {
  if (in_any(labels, circle.location)) return false;
  return std::ranges::none_of(frame.corners_px, [&](const Eigen::Vector2f& corner) {
    const Vec2 px = corner.cast<double>();
    return (px - circle.location).norm() <= circle.radius && in_any(labels, px);
  });
}

/// The number of boxes matched one to one by squares. List positions break ties.
int count_boxed(const recording::FrameRecord& frame, const std::vector<Labelled>& labels) {
  std::vector<BoxPair> pairs;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i].ignored) continue;
    for (std::size_t j = 0; j < frame.layers.squares.size(); ++j) {
      const Square& square = frame.layers.squares[j];
      const double iou =
          recording::intersection_over_union(labels[i].box, recording::box_of(square));
      if (may_move(square) && iou >= kMatch) pairs.push_back({iou, static_cast<int>(i), j});
    }
  }
  return static_cast<int>(one_to_one(std::move(pairs)).size());
}

}  // namespace

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

struct Scorer::State {
  recording::Truth truth;
  recording::WarningWatch warnings;
  Scores scores = {};  ///< without the members that the others determine
  RebelScorer rebels = {};
  SquareScorer squares = {};
  MoverScorer movers;
  std::vector<Id> normal_edges = {};  ///< of the previous frame

  void add_edges(const recording::FrameRecord& frame);
};

Scorer::Scorer(const recording::RunInfo& run)
    : state_(new State{
          .truth = run.truth,
          .warnings = recording::WarningWatch(run.truth),
          .movers = MoverScorer(
              run.camera ? std::optional(cv::Size(run.camera->width_px, run.camera->height_px))
                         : std::nullopt)}) {
  state_->scores.detector = run.detector;
}
Scorer::~Scorer() = default;
Scorer::Scorer(Scorer&&) noexcept = default;

/// Counts the normal edges of the previous frame, and how many of them have a corner in this one.
void Scorer::State::add_edges(const recording::FrameRecord& frame) {
  std::set<Id> supported;
  for (const Edge& edge : frame.layers.normal_edges) {
    if (edge.corner >= 0) supported.insert(edge.id);
  }
  scores.edges += std::ssize(normal_edges);
  scores.rematched_edges +=
      std::ranges::count_if(normal_edges, [&](Id id) { return supported.contains(id); });
  normal_edges.clear();
  for (const Edge& edge : frame.layers.normal_edges) normal_edges.push_back(edge.id);
}

FrameScore Scorer::add(const recording::FrameRecord& frame) {
  require_pairs(frame);
  FrameScore score = state_->rebels.add(frame);
  state_->squares.add(frame);
  state_->movers.add(frame, score.outcomes, state_->rebels.detections());
  state_->warnings.add(frame);
  Scores& scores = state_->scores;
  scores.labels.add(frame);
  ++scores.frames;
  scores.tells_first_sightings |= std::ranges::count(frame.reasons, Reason::first_sighting) > 0;
  for (const sim::ObjectTruth& truth : frame.object_truth) scores.objects_seen.insert(truth.object);
  scores.rebels_found += std::ranges::count(frame.verdicts, Verdict::rebel);
  scores.movers_found += std::ranges::count_if(frame.layers.squares, may_move);
  scores.corner_counts.push_back(static_cast<double>(frame.corners_px.size()));
  if (scores.detector.layered) {
    scores.dimensions.push_back(static_cast<double>(frame.layers.dimension()));
    state_->add_edges(frame);
  }
  if (frame.times) scores.times.push_back(*frame.times);
  if (frame.true_motion.dt_s <= 0) return score;
  const Eigen::AngleAxisd error(frame.motion.R_cur_prev.transpose() * frame.true_motion.R_cur_prev);
  scores.rotation_errors_mrad.push_back(1000 * error.angle());
  scores.velocity_errors_mps.push_back((frame.motion.v_C_mps - frame.true_motion.v_C_mps).norm());
  return score;
}

Metrics Scorer::metrics(const std::optional<sim::Warnings>& world) const {
  Scores scores = state_->scores;
  scores.corners = state_->rebels.corners();
  scores.objects = state_->rebels.objects();
  scores.squares = state_->squares.score();
  scores.movers = state_->movers.score(detections());
  scores.warnings = warned(world);
  Metrics figures;
  for (const Metric& metric : scoring::metrics()) {
    if (!metric.compute) continue;
    const bool is_known = state_->truth <= metric.needs;
    figures.emplace_back(metric.key, is_known ? metric.compute(scores) : std::nullopt);
  }
  return figures;
}

std::vector<recording::Warned> Scorer::warned(const std::optional<sim::Warnings>& world) const {
  return state_->warnings.warned(world);
}

int Scorer::frames() const {
  return state_->scores.frames;
}

const ObjectDetections& Scorer::detections() const {
  return state_->rebels.detections();
}

Metrics score(const recording::Recording& recording) {
  Scorer scorer(recording);
  for (const recording::FrameRecord& frame : recording.frames) scorer.add(frame);
  return scorer.metrics(recording.warnings);
}

std::optional<double> value(const Metrics& metrics, std::string_view name) {
  const auto found = std::ranges::find(metrics, name, &Metrics::value_type::first);
  if (found == metrics.end()) throw std::out_of_range("no metric is called " + std::string(name));
  return found->second;
}

bool may_move(const Square& square) {
  return square.rebel_circles > 0 || square.circles == 0;
}

void LabelScore::add(const recording::FrameRecord& frame) {
  if (!frame.labels || frame.index < recording::kSightings) return;
  ++frames;
  const std::vector<Labelled> labels = labelled(frame);
  const std::vector<Vec2> rebels = rebel_corners(frame);
  for (const Labelled& label : labels) {
    if (label.ignored) continue;
    ++boxes;
    found += std::ranges::count_if(rebels, [&](const Vec2& px) {
               return label.reach.contains(px);
             }) >= kCornersToFind;
  }
  boxed += count_boxed(frame, labels);
  rebels_off += static_cast<int>(
      std::ranges::count_if(rebels, [&](const Vec2& px) { return !in_any(labels, px); }));
  circles_off +=
      static_cast<int>(std::ranges::count_if(frame.layers.rebel_circles, [&](const Circle& circle) {
        return is_off(circle, frame, labels);
      }));
}

}  // namespace lcs::scoring
