#include "filter/edge_expert.h"

#include <algorithm>

#include "filter/geometry.h"
#include "filter/hypotheses/hypothesis_edges.h"
#include "filter/paper_edges.h"
#include "filter/refill.h"

namespace lcs {

void EdgeExpert::assign_one_to_one(std::size_t edges, std::size_t corners) {
  refill(match_of_edge_, edges, -1);
  refill(match_of_corner_, corners, -1);
  order_.visit(
      pairs_,
      [&](const Couple& pair) {
        return match_of_edge_[pair.a] >= 0 || match_of_corner_[pair.b] >= 0;
      },
      [&](const Couple& pair) {
        match_of_edge_[pair.a] = pair.b;
        match_of_corner_[pair.b] = pair.a;
      });
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

void EdgeExpert::move_as_static(Edge& edge, const MotionField& field) const {
  edge.origin = field.origin(edge.location);
  edge.speed = edge.depth_ratio * field.reference_speed(edge.location);
  const Vec2 along = field.direction(edge.location);
  edge.angle = angle_of(along.isZero() ? Vec2(edge.location - camera_.centre_px) : along);
}

Edge EdgeExpert::make_normal(const Vec2& x, double depth_ratio, double mu,
                             const MotionField& field) {
  Edge edge;
  edge.id = next_id();
  edge.location = edge.rotated = edge.predicted = x;
  edge.depth_ratio = depth_ratio;
  move_as_static(edge, field);
  edge.mu = mu;
  edge.trust = trust_.initial_normal();
  return edge;
}

std::unique_ptr<EdgeExpert> make_edge_expert(const Intrinsics& camera,
                                             const CircleParameters& parameters) {
  if (parameters.edge_rule == EdgeRule::paper) {
    return std::make_unique<PaperEdges>(camera, parameters);
  }
  return std::make_unique<HypothesisEdges>(camera, parameters);
}

}  // namespace lcs
