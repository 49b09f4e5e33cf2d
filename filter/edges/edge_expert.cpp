#include "filter/edges/edge_expert.h"

#include "filter/edges/hypothesis_edges.h"
#include "filter/kinematics/geometry.h"
#include "filter/paper/paper_edges.h"

namespace lcs {

void EdgeExpert::bury(std::vector<Edge>& edges) const {
  const Pixels picture{camera_.width_px, camera_.height_px};
  std::erase_if(edges, [&](const Edge& edge) {
    return !trust_.alive(edge.trust) || !picture.contain(edge.location);
  });
}

void EdgeExpert::move_as_static(Edge& edge, const MotionField& field) const {
  edge.origin = field.origin(edge.location);
  edge.speed = edge.depth_ratio * field.reference_speed(edge.location);
  const Vec2 along = field.direction(edge.location);
  edge.angle = angle_of(along.isZero() ? Vec2(edge.location - camera_.centre_px) : along);
}

std::unique_ptr<EdgeExpert> make_edge_expert(const Intrinsics& camera,
                                             const CircleParameters& parameters) {
  if (parameters.edge_rule == EdgeRule::paper) {
    return std::make_unique<PaperEdges>(camera, parameters);
  }
  return std::make_unique<HypothesisEdges>(camera, parameters);
}

}  // namespace lcs
