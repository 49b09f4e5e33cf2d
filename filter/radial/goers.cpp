#include "filter/radial/radial_movers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "filter/edges/gauss.h"
#include "filter/kinematics/geometry.h"
#include "filter/radial/median.h"
#include "filter/vectors/refill.h"

namespace lcs {
/// Joins normal edges to a rebel circle that moves as a static body below the ground would.
void Goers::join(int circle, const RadialFrame& frame) {
  const std::vector<Edge>& rebels = frame.edges.rebel;
  const std::span<const GroundEdge> seen = frame.seen;
  const GroundView& ground = frame.ground;
  apparent_pm_.clear();
  across_px_.clear();
  front_.clear();
  double lowest = -std::numeric_limits<double>::infinity(), second = lowest;
  double left = -lowest, right = lowest;
  for (std::size_t i = 0; i < rebels.size(); ++i) {
    const Edge& edge = rebels[i];
    if (frame.circles.of_edges.rebel[i] != circle || edge.corner < 0) continue;
    // Image motion divided by the image motion of a static point at a depth of 1 m.
    const Vec2 flow_px = frame.field.parallax_px_m(edge.origin);
    const Vec2 step_px = edge.velocity() * frame.field.dt_s();
    if (!(flow_px.norm() > 0)) continue;
    apparent_pm_.push_back(flow_px.dot(step_px) / flow_px.squaredNorm());
    across_px_.push_back(std::abs(cross(flow_px, step_px)) / flow_px.norm());
    const Place& place =
        front_.emplace_back(ground.along(edge.location), ground.down(edge.location));
    left = std::min(left, place.x());
    right = std::max(right, place.x());
    second = std::max(second, std::min(lowest, place.y()));  // the lowest may be a shadow's
    lowest = std::max(lowest, place.y());
  }
  if (std::ssize(front_) < circle_.min_members) return;
  sorted_ = apparent_pm_;
  const double W = median(sorted_);
  for (double& value : sorted_) value = std::abs(value - W);
  const double spread = 1.48 * median(sorted_);
  sorted_ = across_px_;
  if (median(sorted_) > edge_.noise_px) return;
  const double foot_pm = ground.ground_pm(second);  // the body's own inverse depth
  const double rough = 2 * circle_.roughness * foot_pm;
  if (!(foot_pm > 0) || spread > rough) return;
  const double sigma = Eigen::Vector3d(ground.slack_pm(), rough, spread).norm();
  const double sunk = (foot_pm - W) / sigma;
  const double odds = log_odds(edge_.prior) + 0.5 * sunk * sunk;
  if (!(W < foot_pm && odds > 0)) return;

  // Edges of the same apparent depth, reached from the circle in steps of a body's gaps.
  const double gap = circle_.gap_m * foot_pm;
  near_.clear();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const GroundEdge& edge = seen[i];
    const double apparent = std::max(W, 0.0);
    const Eigen::Vector3d sigmas(edge.sigma_pm, spread, circle_.roughness * apparent);
    const bool is_candidate = edge.is_seen && result_.circle[i] < 0 && edge.along > left - gap &&
                              edge.along < right + gap && edge.down < second &&
                              edge.sigma_pm < circle_.roughness * foot_pm &&
                              std::abs(edge.inverse_depth_pm - apparent) < 2 * sigmas.norm() &&
                              edge.inverse_depth_pm + 2 * edge.sigma_pm < foot_pm - sigma;
    if (is_candidate) near_.push_back(static_cast<int>(i));
  }
  while (!front_.empty() && !near_.empty()) {
    next_.clear();
    std::erase_if(near_, [&](int i) {
      const Place place(seen[i].along, seen[i].down);
      const bool is_reached = std::ranges::any_of(
          front_, [&](const Place& from) { return (from - place).squaredNorm() < gap * gap; });
      if (!is_reached) return false;
      result_.circle[i] = circle;
      result_.odds[i] = odds;
      next_.push_back(place);
      return true;
    });
    front_.swap(next_);
  }
}

const Goers::Result& Goers::step(const RadialFrame& frame) {
  refill(result_.circle, frame.seen.size(), -1);
  refill(result_.odds, frame.seen.size());
  for (std::size_t c = 0; c < frame.circles.circles.rebel.size(); ++c) {
    join(static_cast<int>(c), frame);
  }
  return result_;
}

}  // namespace lcs
