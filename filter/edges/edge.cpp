#include "filter/edges/edge.h"

#include "filter/kinematics/geometry.h"

namespace lcs {

void delete_lost(std::vector<Edge>& edges, const Intrinsics& camera, const TrustRanks& trust) {
  const Pixels picture{camera.width_px, camera.height_px};
  std::erase_if(edges, [&](const Edge& edge) {
    return !trust.alive(edge.trust) || !picture.contain(edge.location);
  });
}

void move_as_static(Edge& edge, const Intrinsics& camera, const MotionField& field) {
  edge.origin = field.origin(edge.location);
  edge.speed = edge.depth_ratio * field.reference_speed(edge.location);
  const Vec2 along = field.direction(edge.location);
  edge.angle = angle_of(along.isZero() ? Vec2(edge.location - camera.centre_px) : along);
}

}  // namespace lcs
