#include "filter/paper/feedback.h"

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

}  // namespace lcs::paper
