#include "filter/circles/mean_circle.h"

#include <algorithm>

#include "filter/kinematics/geometry.h"

namespace lcs {

Circle mean_circle(const std::vector<Edge>& edges, std::span<const int> group,
                   const MotionField& field, const Circle& same) {
  Circle mean{.id = same.id, .depth_ratio = 0, .trust = same.trust, .age = same.age};
  Vec2 direction = Vec2::Zero();
  for (const int i : group) {
    const Edge& edge = edges[i];
    mean.location += edge.location;
    mean.origin += edge.origin;
    mean.speed += edge.speed;
    mean.depth_ratio += edge.depth_ratio;
    // The paper adds the deviation mu_r to beta of a rebel. It is unsigned here: it widens the gate
    // (zeta_r) and does not turn the mean.
    direction += unit_vector(edge.angle);
  }
  const double n = static_cast<double>(group.size());
  mean.rebel = edges[group.front()].rebel;
  mean.location /= n;
  mean.origin /= n;
  mean.speed /= n;
  mean.depth_ratio /= n;
  mean.angle = angle_of(direction);
  if (mean.rebel) {
    const double reference = field.reference_speed(mean.location);
    mean.depth_ratio = reference > 0 ? std::min(mean.speed / reference, 2 * field.max_ratio()) : 0;
  }
  for (const int i : group) {
    mean.radius = std::max(mean.radius, (edges[i].location - mean.location).norm());
  }
  mean.members = static_cast<int>(group.size());
  return mean;
}

}  // namespace lcs
