#include "filter/paper/paper_filter.h"

#include <optional>

#include "filter/set_layers.h"
#include "filter/stopwatch.h"
#include "filter/vectors/refill.h"

namespace lcs::paper {
namespace {

/// Cell size of the grid of corners: about a collector's width.
constexpr double kCell_px = 32;

}  // namespace

void Feedback::set_regions(const std::vector<Circle>& normal_circles,
                           const std::vector<Square>& squares, PaperLayers& layers) const {
  auto& [ignored, collectors, chains] = layers;
  ignored.clear();
  collectors.clear();
  make_room(collectors, normal_circles.capacity());  // every circle may become a collector
  for (const Circle& circle : normal_circles) {
    if (circle.ignoring) {
      ignored.push_back(
          {IgnoreRegion::Shape::circle, circle.location, {circle.radius, circle.radius}});
    } else if (circle.trust >= circle_trust_.standard) {
      collectors.push_back({circle.location, circle.radius, circle.depth_ratio});
    }
  }
  for (const Square& square : squares) {
    if (!square.ignoring) continue;
    ignored.push_back({IgnoreRegion::Shape::rectangle, square.location, square.half_size});
  }
}

/// Searches from the collectors, as each contains few corners.
const std::vector<int>& Feedback::group(std::span<const Collector> lambda, const Chi& chi) {
  refill(groups_, chi.size(), -1);
  if (lambda.empty()) return groups_;
  grid_.build(chi.locations, kCell_px);
  refill(nearest_, chi.size());
  for (std::size_t c = 0; c < lambda.size(); ++c) {
    // Slightly farther: the exact test compares distances, not squares.
    grid_.visit_within(lambda[c].location, 1.001 * lambda[c].radius, [&](int i, double) {
      const double distance = (chi.locations[i] - lambda[c].location).norm();
      if (distance > lambda[c].radius) return;
      if (groups_[i] >= 0 && !(distance < nearest_[i])) return;
      groups_[i] = static_cast<int>(c);
      nearest_[i] = distance;
    });
  }
  return groups_;
}

PaperFilter::PaperFilter(const Intrinsics& camera, const PaperParameters& parameters)
    : camera_(camera),
      field_(parameters.field),
      feedback_(parameters.circle.trust),
      line_(camera, parameters.line),
      edge_expert_(camera, parameters.edge, parameters.circle.trust),
      circle_expert_(camera, parameters.circle, parameters.edge.corner_noise, parameters.ignore),
      square_expert_(camera, parameters.square, parameters.ignore) {
  lcs::validate(camera);
  validate(parameters);
}

const FrameResult& PaperFilter::take(std::span<const Eigen::Vector2f> corners_px,
                                     std::span<const Signature> signatures, const EgoMotion& told) {
  Stopwatch<> watch;
  const std::optional<EgoMotion> motion = intake_.take(told, diagnostics_);
  if (!motion) {
    edges_ = {};
    circles_ = {};
    squares_.clear();
  }
  const MotionField field(camera_, motion.value_or(EgoMotion{}), field_);
  PaperEdges::predict(edges_, field);
  PaperCircles::predict(circles_.circles, field);
  PaperSquares::predict(squares_, field);

  auto& [psi, lambda, alpha] = result_.paper;
  feedback_.set_regions(circles_.circles.normal, squares_, result_.paper);
  const Chi& chi = line_.collect(corners_px, signatures, psi);
  count_rejected(chi, diagnostics_);
  const std::vector<int>& groups = feedback_.group(lambda, chi);
  result_.times.line_ms = watch.lap_ms();

  const auto& [verdicts, reasons] = edge_expert_.update(edges_, chi, groups, psi, field);
  circle_expert_.update(edges_.edges, psi, field, circles_);
  result_.times.circle_ms = watch.lap_ms();

  square_expert_.update(circles_.circles, psi, field, squares_);
  result_.times.square_ms = watch.lap_ms();

  assign_verdicts(chi, verdicts, reasons, {}, result_);
  set_layers(edges_.edges, circles_, squares_, result_.layers);
  copy_over(edges_.chains, alpha);
  return result_;
}

}  // namespace lcs::paper
