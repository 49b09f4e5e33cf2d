#include "filter/paper/paper_circles.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "filter/kinematics/geometry.h"
#include "filter/line/line.h"
#include "filter/paper/estimate.h"
#include "filter/vectors/refill.h"

namespace lcs::paper {
namespace {

bool within(double angle_rad, double about_rad, double epsilon_rad) {
  return angle_between(angle_rad, about_rad) <= epsilon_rad;
}

}  // namespace

void PaperCircles::predict(BothKinds<Circle>& circles, const MotionField& field) {
  for (Circle& circle : circles.normal) {
    const Vec2 rotated = field.rotated(circle.location);
    if (field.moving()) circle.depth_ratio = field.advanced_ratio(circle.depth_ratio);
    circle.location = field.translated(rotated, circle.depth_ratio);
    circle.radius *= std::max(0.0, field.expansion(circle.depth_ratio));
    circle.origin = field.origin(circle.location);
    circle.speed = circle.depth_ratio * field.reference_speed(rotated);
    const Vec2 along = field.direction(circle.location);
    if (!along.isZero()) circle.angle = angle_of(along);
  }
  for (Circle& circle : circles.rebel) {
    circle.angle = field.turned(circle.angle, circle.location, circle.origin);
    circle.origin = field.rotated(circle.origin);
    circle.location =
        field.rotated(circle.location) + circle.speed * field.dt_s() * unit_vector(circle.angle);
  }
}

/// Similar direction, and similar depth (normal) or speed (rebel).
bool PaperCircles::alike(const Edge& a, const Edge& b, const MotionField& field) const {
  if (a.rebel) {
    const double tolerance = parameters_.epsilon_v_r * field.reference_speed(a.location);
    return within(a.angle, b.angle, parameters_.epsilon_beta_r) &&
           std::abs(a.speed - b.speed) <= std::max(tolerance, 0.5 * std::max(a.speed, b.speed));
  }
  return std::abs(a.depth_ratio - b.depth_ratio) <= parameters_.epsilon_v_n &&
         (!field.moving() || within(a.angle, b.angle, parameters_.epsilon_beta_n));
}

/// The groups C_m: each starts from the most trusted, then oldest, free edge and adds similar edges
/// near it.
void PaperCircles::group(const std::vector<Edge>& edges, const MotionField& field) {
  free_.clear();
  points_.clear();
  seeds_.clear();
  for (const Edge& edge : edges) {
    if (edge.trust < parameters_.trust.standard) continue;
    seeds_.push_back({edge.trust, edge.age, free_.size()});
    free_.push_back(&edge);
    points_.push_back(edge.location);
  }
  const bool rebels = !edges.empty() && edges.front().rebel;
  const double reach = rebels ? parameters_.reach_r : parameters_.reach_n;
  grid_.build(points_, reach);
  std::ranges::sort(seeds_, {},
                    [](const Seed& s) { return std::tuple(-s.trust, -s.age, s.index); });
  grouped_.clear();
  groups_.clear();
  for (const Seed& seed : seeds_) {
    if (!free_[seed.index]) continue;
    const Edge& edge = *free_[seed.index];
    const std::size_t first = grouped_.size();
    grid_.visit_within(edge.location, reach, [&](int other, double) {
      if (free_[other] && alike(edge, *free_[other], field)) grouped_.push_back(other);
    });
    std::sort(grouped_.begin() + static_cast<std::ptrdiff_t>(first), grouped_.end());
    const std::size_t count = grouped_.size() - first;
    if (static_cast<int>(count) < parameters_.min_members) {
      grouped_.resize(first);
      continue;
    }
    for (std::size_t i = first; i < grouped_.size(); ++i) {
      const Edge*& member = free_[grouped_[i]];
      grouped_[i] = static_cast<int>(member - edges.data());
      member = nullptr;
    }
    Group group{{}, first, count};
    group.mean = mean_circle(edges, members(group), field);
    group.mean.radius += corner_noise_px_;
    groups_.push_back(group);
  }
}

/// Per[ |L_e - L~_c| < R_c ]: share of the group's edges inside the predicted circle, %.
double PaperCircles::overlap(const Circle& circle, const Group& group,
                             const std::vector<Edge>& edges) const {
  int inside = 0;
  for (const int i : members(group)) {
    inside += (edges[i].location - circle.location).norm() < circle.radius;
  }
  return 100.0 * inside / static_cast<double>(group.count);
}

void PaperCircles::estimate_circle(Circle& circle, const Circle& mean, bool aligned) const {
  const TrustRanks& ranks = parameters_.trust;
  circle.location = estimate(circle.trust, ranks, circle.location, mean.location);
  circle.radius = estimate(circle.trust, ranks, circle.radius, mean.radius);
  circle.angle = wrap_angle(
      circle.angle + estimate(circle.trust, ranks, 0.0, wrap_angle(mean.angle - circle.angle)));
  if (circle.rebel) circle.angle = mean.angle;
  circle.origin = mean.origin;
  circle.speed = mean.speed;
  circle.depth_ratio = mean.depth_ratio;
  circle.members = mean.members;
  circle.trust = aligned ? ranks.raised(circle.trust) : circle.trust - 1;
}

void PaperCircles::update_kind(const std::vector<Edge>& edges, std::span<const IgnoreRegion> psi,
                               const MotionField& field, std::vector<Circle>& circles,
                               std::vector<int>& of_edges) {
  group(edges, field);
  refill(of_edges, edges.size(), -1);

  pairs_.clear();
  for (std::size_t c = 0; c < circles.size(); ++c) {
    const Circle& circle = circles[c];
    const double epsilon_beta =
        circle.rebel ? parameters_.epsilon_beta_r : parameters_.epsilon_beta_n;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Circle& mean = groups_[g].mean;
      const double distance = (mean.location - circle.location).norm();
      if (distance > circle.radius + mean.radius) continue;
      const double share = overlap(circle, groups_[g], edges);
      if (share < parameters_.rho_c) continue;
      const double tolerance =
          circle.rebel ? std::max(parameters_.epsilon_v_r * field.reference_speed(mean.location),
                                  0.5 * std::max(circle.speed, mean.speed))
                       : 0;
      const bool speeds =
          circle.rebel ? std::abs(circle.speed - mean.speed) <= tolerance
                       : std::abs(circle.depth_ratio - mean.depth_ratio) <= parameters_.epsilon_v;
      if (!speeds) continue;
      const bool aligned =
          (!circle.rebel && !field.moving()) || within(circle.angle, mean.angle, epsilon_beta);
      pairs_.push_back({share, distance, c, g, aligned});
    }
  }
  std::ranges::sort(pairs_, {}, [](const Pair& pair) {
    return std::tuple(!pair.aligned, -pair.overlap, pair.distance, pair.circle, pair.group);
  });
  // Sized by edges, an upper bound of the number of groups that is steady earlier.
  refill(circle_of_group_, edges.size(), -1);
  refill(matched_, circles.size());
  for (const Pair& pair : pairs_) {
    if (matched_[pair.circle] || circle_of_group_[pair.group] >= 0) continue;
    matched_[pair.circle] = 1;
    circle_of_group_[pair.group] = static_cast<int>(pair.circle);
    Circle& circle = circles[pair.circle];
    ++circle.age;
    // Edges that coast in psi keep their circle alive, but are no evidence.
    const bool unseen = inside_any(psi, circle.location);
    const int trust = circle.trust;
    estimate_circle(circle, groups_[pair.group].mean, pair.aligned);
    if (unseen) circle.trust = trust;
  }
  for (std::size_t c = 0; c < circles.size(); ++c) {
    if (matched_[c]) continue;
    ++circles[c].age;
    circles[c].members = 0;
    // An ignored region cannot show its edges.
    if (inside_any(psi, circles[c].location)) continue;
    --circles[c].trust;
  }
  const std::size_t most = circles.size() + groups_.size();
  if (circles.capacity() < most) circles.reserve(2 * most);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (circle_of_group_[g] >= 0) continue;
    Circle circle = groups_[g].mean;
    circle.id = next_id_++;
    circle.trust =
        circle.rebel ? parameters_.trust.initial_rebel() : parameters_.trust.initial_normal();
    circle_of_group_[g] = static_cast<int>(circles.size());
    circles.push_back(circle);
  }

  // Deletion shifts circles: update the indices stored in edges.
  refill(kept_, circles.size(), -1);
  std::size_t kept = 0;
  for (std::size_t c = 0; c < circles.size(); ++c) {
    const Vec2& x = circles[c].location;
    const bool outside =
        x.x() < 0 || x.y() < 0 || x.x() > camera_.width_px || x.y() > camera_.height_px;
    if (!parameters_.trust.alive(circles[c].trust) || outside) continue;
    kept_[c] = static_cast<int>(kept);
    circles[kept++] = circles[c];
  }
  circles.resize(kept);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    for (const int i : members(group)) {
      of_edges[i] = kept_[static_cast<std::size_t>(circle_of_group_[g])];
    }
  }
}

void PaperCircles::update(const BothKinds<Edge>& edges, std::span<const IgnoreRegion> psi,
                          const MotionField& field, CircleExpert::Result& result) {
  auto& [circles, of_edges] = result;
  update_kind(edges.normal, psi, field, circles.normal, of_edges.normal);
  update_kind(edges.rebel, psi, field, circles.rebel, of_edges.rebel);
  if (!ignore_) return;
  // Rebels are never ignored. An ignored circle loses trust, so that it is observed again.
  for (Circle& circle : circles.normal) {
    circle.ignoring = circle.trust >= parameters_.trust.maximum;
    if (circle.ignoring) circle.trust = parameters_.trust.after_ignoring();
  }
}

}  // namespace lcs::paper
