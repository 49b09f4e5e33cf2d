#include "filter/circles/circle_expert.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "filter/kinematics/geometry.h"
#include "filter/vectors/refill.h"

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

void CircleExpert::forget() {
  result_ = {};
  members_ = {};
}

/// Whether the edges of a group lie on a line, up to `min_width`.
bool CircleExpert::is_line(const std::vector<Edge>& edges, std::span<const int> group) const {
  Vec2 mean = Vec2::Zero();
  for (const int i : group) mean += edges[i].location;
  mean /= static_cast<double>(group.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const int i : group) {
    const Vec2 off = edges[i].location - mean;
    scatter += off * off.transpose();
  }
  // The variance across the line is the lesser eigenvalue, t - sqrt(t^2 - det).
  const double t = 0.5 * scatter.trace();
  const double least = t - std::sqrt(std::max(0.0, t * t - scatter.determinant()));
  return least < parameters_.min_width * parameters_.min_width * static_cast<double>(group.size());
}

/// Assigns groups to circles of the last frame; pairs that share the most edges come first.
void CircleExpert::match(const std::vector<Edge>& edges, std::size_t circles,
                         const std::vector<Member>& before) {
  shares_.clear();
  make_room(shares_, edges.size());
  for (std::size_t g = 0; g < found_.size(); ++g) {
    for (const int i : groups_.edges(found_[g])) {
      const auto was = std::ranges::lower_bound(before, edges[i].id, {}, &Member::edge);
      if (was == before.end() || was->edge != edges[i].id) continue;
      shares_.push_back({1, was->circle, g});
    }
  }
  const auto place = [](const Share& s) { return std::tuple(s.circle, s.group); };
  std::ranges::sort(shares_, {}, place);
  std::size_t last = 0;
  for (std::size_t s = 1; s < shares_.size(); ++s) {
    if (place(shares_[s]) == place(shares_[last])) {
      ++shares_[last].edges;
    } else {
      shares_[++last] = shares_[s];
    }
  }
  if (!shares_.empty()) shares_.resize(last + 1);
  std::ranges::sort(shares_, {},
                    [](const Share& s) { return std::tuple(-s.edges, s.circle, s.group); });
  refill(circle_of_group_, found_.size(), -1);
  refill(group_of_circle_, circles, -1);
  for (const Share& share : shares_) {
    if (circle_of_group_[share.group] >= 0 || group_of_circle_[share.circle] >= 0) continue;
    circle_of_group_[share.group] = share.circle;
    group_of_circle_[share.circle] = static_cast<int>(share.group);
  }
}

/// Groups the edges of one kind. Deletes each circle of the last frame that has no group.
void CircleExpert::regroup(const std::vector<Edge>& edges, const MotionField& field,
                           std::vector<Circle>& circles, std::vector<int>& of_edges,
                           std::vector<Member>& members) {
  const TrustRanks& ranks = parameters_.trust;
  found_.clear();
  make_room(found_, edges.size());
  for (const MotionGroups::Group& group : groups_.group(edges, field)) {
    if (group.ground || group.count < static_cast<std::size_t>(parameters_.min_members)) continue;
    if (!is_line(edges, groups_.edges(group))) found_.push_back(group);
  }
  match(edges, circles.size(), members);

  refill(of_edges, edges.size(), -1);
  next_.clear();
  make_room(next_, found_.size());
  const auto add = [&](std::size_t g, const Circle& same) {
    const auto of_group = groups_.edges(found_[g]);
    for (const int i : of_group) of_edges[i] = static_cast<int>(next_.size());
    next_.push_back(mean_circle(edges, of_group, field, same));
  };
  for (std::size_t c = 0; c < circles.size(); ++c) {
    Circle& circle = circles[c];
    if (group_of_circle_[c] < 0) continue;
    circle.trust = ranks.raised(circle.trust);
    ++circle.age;
    add(static_cast<std::size_t>(group_of_circle_[c]), circle);
  }
  for (std::size_t g = 0; g < found_.size(); ++g) {
    if (circle_of_group_[g] >= 0) continue;
    const bool rebel = edges[groups_.edges(found_[g]).front()].rebel;
    add(g, {.id = next_id_++, .trust = rebel ? ranks.initial_rebel() : ranks.initial_normal()});
  }
  copy_over(next_, circles);
  members.clear();
  make_room(members, edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (of_edges[i] >= 0) members.push_back({edges[i].id, of_edges[i]});
  }
}

const CircleExpert::Result& CircleExpert::step(const BothKinds<Edge>& edges,
                                               const MotionField& field) {
  auto& [circles, of_edges] = result_;
  regroup(edges.normal, field, circles.normal, of_edges.normal, members_.normal);
  regroup(edges.rebel, field, circles.rebel, of_edges.rebel, members_.rebel);
  return result_;
}

}  // namespace lcs
