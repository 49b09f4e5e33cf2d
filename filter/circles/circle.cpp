#include "filter/circles/circle.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "filter/circles/mean_circle.h"
#include "filter/kinematics/geometry.h"
#include "filter/line/line.h"
#include "filter/matching/refill.h"

namespace lcs {

CircleExpert::CircleExpert(const Intrinsics& camera, const CircleParameters& parameters)
    : parameters_(parameters), paper_(camera, parameters), groups_(camera, parameters) {}

void CircleExpert::predict(Layers& layers, const MotionField& field) const {
  for (Circle& circle : layers.normal_circles) {
    const Vec2 rotated = field.rotated(circle.location);
    if (field.moving()) circle.depth_ratio = field.advanced_ratio(circle.depth_ratio);
    circle.location = field.translated(rotated, circle.depth_ratio);
    circle.radius *= std::max(0.0, field.expansion(circle.depth_ratio));
    circle.origin = field.origin(circle.location);
    circle.speed = circle.depth_ratio * field.reference_speed(rotated);
    const Vec2 along = field.direction(circle.location);
    if (!along.isZero()) circle.angle = angle_of(along);
  }
  for (Circle& circle : layers.rebel_circles) {
    circle.angle = field.turned(circle.angle, circle.location, circle.origin);
    circle.origin = field.rotated(circle.origin);
    circle.location =
        field.rotated(circle.location) + circle.speed * field.dt_s() * unit_vector(circle.angle);
  }
}

void CircleExpert::feed_back(const Layers& layers, std::vector<IgnoreRegion>& psi,
                             std::vector<Collector>& lambda) const {
  lambda.reserve(layers.normal_circles.capacity());  // every circle may come to collect
  for (const Circle& circle : layers.normal_circles) {
    if (circle.ignoring) {
      psi.push_back({IgnoreRegion::Shape::circle, circle.location, {circle.radius, circle.radius}});
    } else if (circle.trust >= parameters_.trust.standard) {
      lambda.push_back({circle.location, circle.radius, circle.depth_ratio});
    }
  }
}

/// Whether a group lies along a line.
bool CircleExpert::is_line(const std::vector<Edge>& edges, std::span<const int> group) const {
  Vec2 mean = Vec2::Zero();
  for (const int i : group) mean += edges[i].location;
  mean /= static_cast<double>(group.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const int i : group) {
    const Vec2 off = edges[i].location - mean;
    scatter += off * off.transpose();
  }
  // Across the line their deviation is the root of the lesser eigenvalue, t - sqrt(t^2 - det).
  const double t = 0.5 * scatter.trace();
  const double least = t - std::sqrt(std::max(0.0, t * t - scatter.determinant()));
  return least < parameters_.min_width * parameters_.min_width * static_cast<double>(group.size());
}

/// Which group goes on as which circle: most edges in common first. Of each group, -1: none.
void CircleExpert::match(const std::vector<Edge>& edges, const std::vector<Circle>& circles,
                         const std::vector<Member>& before) {
  shares_.clear();
  make_room(shares_, edges.size());
  for (std::size_t g = 0; g < found_.size(); ++g) {
    for (const int i : groups_.edges(found_[g])) {
      const auto was = std::lower_bound(before.begin(), before.end(), edges[i].id,
                                        [](const Member& m, Id id) { return m.edge < id; });
      if (was == before.end() || was->edge != edges[i].id) continue;
      shares_.push_back({1, was->circle, g});
    }
  }
  const auto place = [](const Share& s) { return std::tuple(s.circle, s.group); };
  std::sort(shares_.begin(), shares_.end(),
            [&](const Share& a, const Share& b) { return place(a) < place(b); });
  std::size_t last = 0;
  for (std::size_t s = 1; s < shares_.size(); ++s) {
    if (place(shares_[s]) == place(shares_[last])) {
      ++shares_[last].edges;
    } else {
      shares_[++last] = shares_[s];
    }
  }
  if (!shares_.empty()) shares_.resize(last + 1);
  std::sort(shares_.begin(), shares_.end(), [](const Share& a, const Share& b) {
    return std::tuple(-a.edges, a.circle, a.group) < std::tuple(-b.edges, b.circle, b.group);
  });
  refill(circle_of_group_, found_.size(), -1);
  refill(group_of_circle_, circles.size(), -1);
  for (const Share& share : shares_) {
    if (circle_of_group_[share.group] >= 0 || group_of_circle_[share.circle] >= 0) continue;
    circle_of_group_[share.group] = share.circle;
    group_of_circle_[share.circle] = static_cast<int>(share.group);
  }
}

/// Groups the edges of one kind anew. A circle is where its edges are, and without any it is gone,
/// unless nobody looked.
void CircleExpert::regroup(std::vector<Edge>& edges, std::vector<Circle>& circles,
                           std::vector<Member>& members, const Layers& layers,
                           const MotionField& field) {
  const TrustRanks& ranks = parameters_.trust;
  found_.clear();
  make_room(found_, edges.size());
  for (const MotionGroups::Group& group : groups_.group(edges, field)) {
    if (group.ground || group.count < static_cast<std::size_t>(parameters_.min_members)) continue;
    const auto of_group = groups_.edges(group);
    if (is_line(edges, of_group)) continue;
    found_.push_back(group);
  }
  match(edges, circles, members);

  for (Edge& edge : edges) edge.circle = -1;
  next_.clear();
  make_room(next_, circles.size() + found_.size());
  const auto add = [&](std::size_t g, Id id, int trust, int age) {
    const auto of_group = groups_.edges(found_[g]);
    for (const int i : of_group) edges[i].circle = static_cast<int>(next_.size());
    Circle circle = mean_circle(edges, of_group, field);
    circle.id = id;
    circle.trust = trust;
    circle.age = age;
    next_.push_back(circle);
  };
  for (std::size_t c = 0; c < circles.size(); ++c) {
    Circle& circle = circles[c];
    if (const int g = group_of_circle_[c]; g >= 0) {
      add(static_cast<std::size_t>(g), circle.id, ranks.raised(circle.trust), circle.age + 1);
    } else if (inside_any(layers.ignored, circle.location)) {
      circle.members = 0;
      ++circle.age;
      next_.push_back(circle);
    }
  }
  for (std::size_t g = 0; g < found_.size(); ++g) {
    if (circle_of_group_[g] >= 0) continue;
    const bool rebel = edges[groups_.edges(found_[g]).front()].rebel;
    add(g, next_id_++, rebel ? ranks.initial_rebel() : ranks.initial_normal(), 0);
  }
  copy_over(next_, circles);
  members.clear();
  make_room(members, edges.size());
  for (const Edge& edge : edges) {
    if (edge.circle >= 0) members.push_back({edge.id, edge.circle});
  }
}

void CircleExpert::update(Layers& layers, const MotionField& field) {
  if (parameters_.edge_rule == EdgeRule::paper) {
    paper_.update(layers.normal_edges, layers.normal_circles, layers, field);
    paper_.update(layers.rebel_edges, layers.rebel_circles, layers, field);
  } else {
    regroup(layers.normal_edges, layers.normal_circles, normal_members_, layers, field);
    regroup(layers.rebel_edges, layers.rebel_circles, rebel_members_, layers, field);
  }
}

void CircleExpert::update_ignorance(Layers& layers) const {
  for (Circle& circle : layers.normal_circles) {
    circle.ignoring = circle.trust >= parameters_.trust.maximum;
    if (circle.ignoring) circle.trust = parameters_.trust.after_ignoring();
  }
}

}  // namespace lcs
