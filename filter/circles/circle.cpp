#include "filter/circles/circle.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "filter/kinematics/geometry.h"
#include "filter/line/line.h"
#include "filter/matching/refill.h"

namespace lcs {
namespace {

bool within(double angle_rad, double about_rad, double epsilon_rad) {
  return angle_between(angle_rad, about_rad) <= epsilon_rad;
}

}  // namespace

CircleExpert::CircleExpert(const Intrinsics& camera, const CircleParameters& parameters)
    : camera_(camera), parameters_(parameters) {}

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

/// Like direction, like depth (normal) or like speed (rebel).
bool CircleExpert::alike(const Edge& a, const Edge& b, const MotionField& field) const {
  if (a.rebel) {
    const double tolerance = parameters_.epsilon_v_r * field.reference_speed(a.location);
    return within(a.angle, b.angle, parameters_.epsilon_beta_r) &&
           std::abs(a.speed - b.speed) <= std::max(tolerance, 0.5 * std::max(a.speed, b.speed));
  }
  return std::abs(a.depth_ratio - b.depth_ratio) <= parameters_.epsilon_v_n &&
         (!field.moving() || within(a.angle, b.angle, parameters_.epsilon_beta_n));
}

CircleExpert::Group CircleExpert::mean_circle(const std::vector<Edge>& edges, std::size_t first,
                                              std::size_t count, const MotionField& field) const {
  Group group;
  group.first = first;
  group.count = count;
  Circle& mean = group.mean;
  AngleMean angle;
  mean.depth_ratio = mean.speed = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    const Edge& edge = edges[grouped_[i]];
    mean.location += edge.location;
    mean.origin += edge.origin;
    mean.speed += edge.speed;
    mean.depth_ratio += edge.depth_ratio;
    // The deviation mu_r that the paper adds to beta of a rebel is unsigned here, and so widens the
    // gate (zeta_r) instead of turning the mean.
    angle.add(edge.angle);
  }
  const double n = static_cast<double>(count);
  mean.rebel = edges[grouped_[first]].rebel;
  mean.location /= n;
  mean.origin /= n;
  mean.speed /= n;
  mean.depth_ratio /= n;
  mean.angle = angle.value();
  if (mean.rebel) {
    const double reference = field.reference_speed(mean.location);
    mean.depth_ratio = reference > 0 ? std::min(mean.speed / reference, 2 * field.max_ratio()) : 0;
  }
  for (std::size_t i = first; i < first + count; ++i) {
    mean.radius = std::max(mean.radius, (edges[grouped_[i]].location - mean.location).norm());
  }
  mean.radius += parameters_.corner_noise;
  mean.members = static_cast<int>(count);
  return group;
}

/// Whether the members grouped from `first` on lie along a line.
bool CircleExpert::is_line(std::size_t first) const {
  const auto members = std::span(grouped_).subspan(first);
  Vec2 mean = Vec2::Zero();
  for (const std::size_t i : members) mean += free_[i]->location;
  mean /= static_cast<double>(members.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const std::size_t i : members) {
    const Vec2 off = free_[i]->location - mean;
    scatter += off * off.transpose();
  }
  // Across the line their deviation is the root of the lesser eigenvalue, t - sqrt(t^2 - det).
  const double t = 0.5 * scatter.trace();
  const double least = t - std::sqrt(std::max(0.0, t * t - scatter.determinant()));
  return least <
         parameters_.min_width * parameters_.min_width * static_cast<double>(members.size());
}

/// The groups C_m: each starts from the most trusted edge that is still free, of those the oldest,
/// and takes the edges near it that are like it.
void CircleExpert::group(const std::vector<Edge>& edges, const MotionField& field) {
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
  std::sort(seeds_.begin(), seeds_.end(), [](const Seed& a, const Seed& b) {
    return std::tuple(-a.trust, -a.age, a.index) < std::tuple(-b.trust, -b.age, b.index);
  });
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
    if (static_cast<int>(count) < parameters_.min_members ||
        (rebels && parameters_.min_width > 0 && is_line(first))) {
      grouped_.resize(first);
      continue;
    }
    for (std::size_t i = first; i < grouped_.size(); ++i) {
      const Edge*& member = free_[grouped_[i]];
      grouped_[i] = static_cast<std::size_t>(member - edges.data());
      member = nullptr;
    }
    groups_.push_back(mean_circle(edges, first, count, field));
  }
}

/// Per[ |L_e - L~_c| < R_c ]: share of the group's edges inside the predicted circle, %.
double CircleExpert::overlap(const Circle& circle, const Group& group,
                             const std::vector<Edge>& edges) const {
  int inside = 0;
  for (std::size_t i = group.first; i < group.first + group.count; ++i) {
    inside += (edges[grouped_[i]].location - circle.location).norm() < circle.radius;
  }
  return 100.0 * inside / static_cast<double>(group.count);
}

void CircleExpert::estimate_circle(Circle& circle, const Circle& mean, bool aligned) const {
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

void CircleExpert::match(std::vector<Edge>& edges, std::vector<Circle>& circles,
                         const Layers& layers, const MotionField& field) {
  group(edges, field);
  for (Edge& edge : edges) edge.circle = -1;

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
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tuple(!a.aligned, -a.overlap, a.distance, a.circle, a.group) <
           std::tuple(!b.aligned, -b.overlap, b.distance, b.circle, b.group);
  });
  // As long as there could be groups, whose number is steady only when the edges' has long been.
  refill(circle_of_group_, edges.size(), -1);
  refill(matched_, circles.size());
  for (const Pair& pair : pairs_) {
    if (matched_[pair.circle] || circle_of_group_[pair.group] >= 0) continue;
    matched_[pair.circle] = 1;
    circle_of_group_[pair.group] = static_cast<int>(pair.circle);
    Circle& circle = circles[pair.circle];
    ++circle.age;
    // Edges that coast in psi carry their circle along, but prove nothing.
    const bool unseen = inside_any(layers.ignored, circle.location);
    const int trust = circle.trust;
    estimate_circle(circle, groups_[pair.group].mean, pair.aligned);
    if (unseen) circle.trust = trust;
  }
  for (std::size_t c = 0; c < circles.size(); ++c) {
    if (matched_[c]) continue;
    ++circles[c].age;
    circles[c].members = 0;
    // A region that was not looked at had no chance to show its edges.
    if (inside_any(layers.ignored, circles[c].location)) continue;
    circles[c].trust -= circles[c].rebel ? parameters_.rebel_coast : 1;
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

  // Deletion shifts the indices that edges keep.
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
    for (std::size_t i = group.first; i < group.first + group.count; ++i) {
      edges[grouped_[i]].circle = kept_[static_cast<std::size_t>(circle_of_group_[g])];
    }
  }
}

void CircleExpert::update(Layers& layers, const MotionField& field) {
  match(layers.normal_edges, layers.normal_circles, layers, field);
  match(layers.rebel_edges, layers.rebel_circles, layers, field);
}

void CircleExpert::update_ignorance(Layers& layers) const {
  for (Circle& circle : layers.normal_circles) {
    circle.ignoring = circle.trust >= parameters_.trust.maximum;
    if (circle.ignoring) circle.trust = parameters_.trust.after_ignoring();
  }
}

}  // namespace lcs
