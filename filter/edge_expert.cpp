#include "filter/edge_expert.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "filter/constellation_edges.h"
#include "filter/geometry.h"
#include "filter/paper_edges.h"
#include "filter/refill.h"

namespace lcs {
namespace {

/// Share of a path's information that stays from frame to frame: its ends err alike, so that more
/// frames do not add up for ever.
constexpr double kPathMemory = 0.8;

/// px^2: far above what any path gives; a camera that flees at an absurd speed would take it to
/// infinity.
constexpr double kMostPathWeight = 1e50;

}  // namespace

void EdgeExpert::assign_one_to_one(std::size_t edges, std::size_t corners) {
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tuple(a.cost, a.edge, a.corner) < std::tuple(b.cost, b.edge, b.corner);
  });
  refill(match_of_edge_, edges, -1);
  refill(match_of_corner_, corners, -1);
  for (const Pair& pair : pairs_) {
    if (match_of_edge_[pair.edge] >= 0 || match_of_corner_[pair.corner] >= 0) continue;
    match_of_edge_[pair.edge] = pair.corner;
    match_of_corner_[pair.corner] = pair.edge;
  }
}

void EdgeExpert::coast(Edge& edge, const std::vector<IgnoreRegion>& psi) const {
  edge.corner = -1;
  edge.location = edge.predicted;
  if (!inside_any(psi, edge.predicted)) --edge.trust;
}

void EdgeExpert::bury(std::vector<Edge>& edges) const {
  std::erase_if(edges, [&](const Edge& edge) {
    return !trust_.alive(edge.trust) || edge.location.x() < -0.5 || edge.location.y() < -0.5 ||
           edge.location.x() > camera_.width_px - 0.5 ||
           edge.location.y() > camera_.height_px - 0.5;
  });
}

void EdgeExpert::predict_path(Edge& edge, const MotionField& field) {
  edge.anchor = field.rotated(edge.anchor);
  edge.travelled_C_m = field.R_cur_prev() * edge.travelled_C_m + field.displacement_C_m();
  if (!field.moving()) return;
  const double before = edge.path_ratio;
  edge.path_ratio = field.advanced_ratio(before);
  // The information shrinks as its unit, the ratio squared, grows.
  if (before > 0) {
    edge.path_weight =
        std::min(edge.path_weight * std::pow(before / edge.path_ratio, 4), kMostPathWeight);
  }
}

void EdgeExpert::measure_path(Edge& edge, const Vec2& x, const MotionField& field) const {
  const double parallax = field.parallax(edge.anchor, edge.travelled_C_m);
  const double weight = parallax * parallax;
  if (weight <= 0) return;
  const double memory = kPathMemory * edge.path_weight;
  const double measured = field.ratio_from(x, edge.anchor, edge.travelled_C_m);
  edge.path_ratio = (memory * edge.path_ratio + weight * measured) / (memory + weight);
  edge.path_weight = std::min(memory + weight, kMostPathWeight);
}

Edge EdgeExpert::make_normal(const Vec2& x, double depth_ratio, double mu,
                             const MotionField& field) {
  Edge edge;
  edge.id = next_id();
  edge.location = edge.rotated = edge.predicted = edge.anchor = x;
  edge.origin = field.origin(x);
  edge.depth_ratio = edge.path_ratio = depth_ratio;
  edge.speed = depth_ratio * field.reference_speed(x);
  const Vec2 along = field.direction(x);
  edge.angle = angle_of(along.isZero() ? Vec2(x - camera_.centre_px) : along);
  edge.mu = mu;
  edge.trust = trust_.initial_normal();
  return edge;
}

std::unique_ptr<EdgeExpert> make_edge_expert(const Intrinsics& camera,
                                             const CircleParameters& parameters) {
  if (parameters.edge_rule == EdgeRule::paper) {
    return std::make_unique<PaperEdges>(camera, parameters);
  }
  return std::make_unique<ConstellationEdges>(camera, parameters);
}

}  // namespace lcs
