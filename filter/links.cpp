#include "filter/links.h"

#include <algorithm>
#include <cmath>

#include "filter/geometry.h"

namespace lcs {
namespace {

/// The local spacing is looked for up to this far.
constexpr double kSpacingReach_px = 60;

/// Of the grid: about as wide as the spacing of corners where they are many.
constexpr double kCell_px = 12;

/// Linked neighbours differ by more than the plain tolerance where their depths are poorly known,
/// but never by more than this many times it.
constexpr double kUncertainTolerance = 3;

/// However long its path, a depth is not known better than this share.
constexpr double kDepthFloor = 0.015;

}  // namespace

LinkLayering::LinkLayering(const Intrinsics& camera, const LinkParameters& parameters)
    : camera_(camera), parameters_(parameters) {}

void LinkLayering::gather(const std::vector<Edge>& edges, const MotionField& field) {
  nodes_.clear();
  points_.clear();
  for (const Edge& edge : edges) {
    if (edge.corner < 0 || (edge.rebel && !edge.called)) continue;
    Node node;
    node.location = edge.location;
    node.edge = &edge;
    if (edge.rebel) {
      node.velocity_pxps = edge.velocity();
    } else {
      if (edge.path_weight <= 0) continue;
      node.w = edge.path_ratio / field.reference_depth_m();
      node.sigma =
          std::max(kDepthFloor * node.w, parameters_.corner_sigma / std::sqrt(edge.path_weight) /
                                             field.reference_depth_m());
    }
    nodes_.push_back(node);
    points_.push_back(node.location);
  }
  grid_.build(points_, kCell_px);
  measure_spacing();
}

void LinkLayering::measure_spacing() {
  const auto count = static_cast<std::size_t>(parameters_.neighbour);
  for (Node& node : nodes_) {
    // Of its own surface: what lies behind an object or before it says nothing of its spacing.
    const auto like = [&](int j) {
      return !parameters_.like_neighbours || node.edge->rebel ||
             std::abs(nodes_[j].w - node.w) < tolerance(nodes_[j], node);
    };
    // One more, for the first is the node itself.
    grid_.nearest(node.location, kSpacingReach_px, count + 1, like, near_);
    node.spacing = near_.size() > count ? std::sqrt(near_.back().first) : kSpacingReach_px;
  }
}

double LinkLayering::tolerance(const Node& a, const Node& b) const {
  const double w = 0.5 * (a.w + b.w);
  const double plain = parameters_.depth_share * w + parameters_.depth_spread * w * w;
  return std::clamp(std::hypot(a.sigma, b.sigma), plain, kUncertainTolerance * plain);
}

double LinkLayering::reach(const Node& a, const Node& b) const {
  return std::clamp(parameters_.spacing * std::min(a.spacing, b.spacing), parameters_.reach_min,
                    parameters_.reach_max);
}

void LinkLayering::link_by_depth() {
  by_depth_.reset(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& a = nodes_[i];
    by_depth_.set_depth(i, a.w, std::max(a.sigma, 1e-3));
    // A hair farther than a reaches, for the rounding of the distances that are compared.
    grid_.visit_within(a.location, 1.001 * reach(a, a), [&](int j, double distance2) {
      if (j <= static_cast<int>(i)) return;
      const Node& b = nodes_[j];
      const double distance = std::sqrt(distance2), longest = reach(a, b);
      if (distance > longest) return;
      const double difference = std::abs(a.w - b.w), most = tolerance(a, b);
      if (!(difference < most)) return;
      by_depth_.link(2 * difference / most + distance / longest, static_cast<int>(i), j);
    });
  }
  by_depth_.merge_links(
      [&](double w) { return parameters_.depth_share * w + parameters_.mean_spread * w * w; });
}

void LinkLayering::link_by_velocity(double dt_s) {
  by_velocity_.reset(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& a = nodes_[i];
    grid_.visit_within(a.location, parameters_.reach_max, [&](int j, double) {
      if (j <= static_cast<int>(i)) return;
      const Node& b = nodes_[j];
      const double step = (a.velocity_pxps - b.velocity_pxps).norm() * dt_s;
      const double mean = 0.5 * (a.velocity_pxps.norm() + b.velocity_pxps.norm()) * dt_s;
      if (step < std::max(parameters_.rebel_speed_px, parameters_.rebel_speed_share * mean)) {
        by_velocity_.join(static_cast<int>(i), j);
      }
    });
  }
}

void LinkLayering::make_square(std::span<const int> group, const MotionField& field) {
  xs_.clear();
  ys_.clear();
  const double n = static_cast<double>(group.size());
  Square square;
  Vec2 velocity = Vec2::Zero(), origin = Vec2::Zero();
  double ratio = 0, speed = 0, weights = 0;
  for (const int i : group) {
    const Node& node = nodes_[i];
    xs_.push_back(node.location.x());
    ys_.push_back(node.location.y());
    const double weight = node.edge->rebel ? 1 : 1 / (node.sigma * node.sigma);
    ratio +=
        weight * (node.edge->rebel ? node.edge->depth_ratio : node.w * field.reference_depth_m());
    weights += weight;
    speed += node.edge->speed / n;
    velocity += node.edge->velocity() / n;
    origin += node.edge->origin / n;
  }
  std::sort(xs_.begin(), xs_.end());
  std::sort(ys_.begin(), ys_.end());
  const auto cut = static_cast<std::size_t>(parameters_.trim * n);
  const Vec2 low(xs_[cut], ys_[cut]);
  const Vec2 high(xs_[xs_.size() - 1 - cut], ys_[ys_.size() - 1 - cut]);
  const Vec2 size = high - low;
  const double longest = parameters_.max_side * std::max(camera_.width_px, camera_.height_px);
  if (size.prod() < parameters_.min_area || size.maxCoeff() > longest) return;
  const bool rebel = nodes_[group.front()].edge->rebel;
  const double largest_px =
      parameters_.max_size * camera_.focal_px * ratio / weights / field.reference_depth_m();
  if (!rebel && size.maxCoeff() > largest_px) return;
  square.location = 0.5 * (low + high);
  square.half_size = 0.5 * size;
  square.origin = origin;
  square.depth_ratio = ratio / weights;
  square.speed = rebel ? velocity.norm() : speed;
  const Vec2 along = rebel ? velocity : field.direction(square.location);
  square.angle = angle_of(along.isZero() ? Vec2(square.location - origin) : along);
  // The circles that the layer's edges are in.
  circles_.clear();
  for (const int i : group) circles_.push_back(nodes_[i].edge->circle);
  std::sort(circles_.begin(), circles_.end());
  const auto end = std::unique(circles_.begin(), circles_.end());
  square.circles = std::max(1, static_cast<int>(end - circles_.begin()));
  square.rebel_circles = rebel ? square.circles : 0;
  squares_.push_back(square);
}

void LinkLayering::make_squares(DisjointSets& sets, std::size_t least, const MotionField& field) {
  groups_.collect(sets, [](std::size_t) { return true; });
  groups_.visit([&](std::span<const int> group) {
    if (group.size() >= least) make_square(group, field);
  });
}

const std::vector<Square>& LinkLayering::layer(const Layers& layers, const MotionField& field) {
  squares_.clear();
  gather(layers.normal_edges, field);
  link_by_depth();
  make_squares(by_depth_.sets(), static_cast<std::size_t>(parameters_.min_edges), field);
  gather(layers.rebel_edges, field);
  link_by_velocity(field.dt_s());
  make_squares(by_velocity_, static_cast<std::size_t>(parameters_.min_rebels), field);
  return squares_;
}

}  // namespace lcs
