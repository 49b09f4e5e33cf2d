#include "filter/squares/links.h"

#include <algorithm>
#include <cmath>

#include "filter/kinematics/geometry.h"

namespace lcs {
namespace {

/// Edges that are looked at round each, about.
constexpr double kCrowd = 48;

/// Of the grid.
constexpr double kCell_px = 24;

/// Velocities are measured over about as long; shorter frames do not make them more like each
/// other.
constexpr double kSpeedTime_s = 0.1;

/// However badly their depths are known, no more than this share of a difference is put down to it.
constexpr double kMostError = 0.05;

/// However long its path, a depth is not known better than this share.
constexpr double kDepthFloor = 0.015;

}  // namespace

LinkLayering::LinkLayering(const Intrinsics& camera, const LinkParameters& parameters)
    : camera_(camera), parameters_(parameters) {}

/// \param upward what a distance upwards counts, where that direction is known.
void LinkLayering::gather(const std::vector<Edge>& edges, double upward, const MotionField& field) {
  const auto along_horizon = field.along_horizon();
  const auto upright = along_horizon ? UprightMetric{*along_horizon, upward} : UprightMetric{};
  nodes_.clear();
  depths_.clear();
  points_.clear();
  companions_.clear();
  for (const Edge& edge : edges) {
    if (edge.corner < 0) continue;
    Node node;
    node.edge = &edge;
    if (edge.rebel) {
      node.velocity_pxps = edge.velocity();
    } else {
      if (!std::isfinite(edge.depth_ratio_sigma)) continue;
      const double w = edge.depth_ratio / field.reference_depth_m();
      depths_.push_back(
          {w, std::max(kDepthFloor * w, edge.depth_ratio_sigma / field.reference_depth_m())});
    }
    nodes_.push_back(node);
    points_.push_back(upright(edge.location));
  }
  grid_.build(points_, kCell_px);
}

/// What follows a rebel tells nothing of its motion, but how far its body reaches.
void LinkLayering::take_in(std::span<const Follower> followers) {
  if (companions_.capacity() < followers.size()) {
    companions_.reserve(followers.size() + followers.size() / 2);
  }
  for (const Follower& follower : followers) {
    // Ids rise in the lists of edges.
    const auto node =
        std::lower_bound(nodes_.begin(), nodes_.end(), follower.edge,
                         [](const Node& before, Id id) { return before.edge->id < id; });
    if (node == nodes_.end() || node->edge->id != follower.edge) continue;
    companions_.push_back({static_cast<int>(node - nodes_.begin()), follower.location});
  }
  std::sort(companions_.begin(), companions_.end(),
            [](const Companion& a, const Companion& b) { return a.node < b.node; });
}

double LinkLayering::reach(double w) const {
  return std::max(parameters_.reach_rad, parameters_.reach_m * w) * camera_.focal_px;
}

double LinkLayering::distance2(const Depth& a, const Depth& b, double apart2_px2) const {
  const double w = 0.5 * (a.w + b.w);
  const double difference = std::abs(a.w - b.w);
  // Most are not alike at all; asked first, for it costs least.
  if (!(difference < (parameters_.depth_share + kMostError) * w)) return 1;
  const double sigma = std::sqrt(a.sigma * a.sigma + b.sigma * b.sigma);
  const double error = std::min(parameters_.depth_error * sigma, kMostError * w);
  const double in_depth = std::max(difference - error, 0.0) / (parameters_.depth_share * w);
  const double reach_px = reach(w);
  return apart2_px2 / (reach_px * reach_px) + in_depth * in_depth;
}

void LinkLayering::link_by_depth() {
  // The mean of two inverse depths that are alike is larger than either by this at the most.
  const double nearest = 1 + parameters_.depth_share + kMostError;
  by_depth_.reset(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    by_depth_.set_depth(i, depths_[i].w, std::max(depths_[i].sigma, 1e-3));
  }
  by_depth_.link_near(
      grid_, kCrowd, [&](int i) { return reach(nearest * depths_[i].w); },
      [&](int i, int j, double apart2) { return distance2(depths_[i], depths_[j], apart2); });
  by_depth_.merge_links(
      [&](double w) { return parameters_.mean_share * w + parameters_.mean_spread * w * w; });
}

void LinkLayering::link_by_velocity(double dt_s) {
  const double reach_px = parameters_.rebel_reach_rad * camera_.focal_px;
  const double unit_s = std::max(dt_s, kSpeedTime_s);
  by_velocity_.reset(nodes_.size());
  grid_.visit_pairs(
      [&](int) { return reach_px; },
      [&](int i, int j, double) {
        const Node &a = nodes_[i], &b = nodes_[j];
        if (by_velocity_.are_joined(i, j)) return;
        const double step = (a.velocity_pxps - b.velocity_pxps).norm() * unit_s;
        const double mean = 0.5 * (a.edge->speed + b.edge->speed) * unit_s;
        if (step < std::max(parameters_.rebel_speed_px, parameters_.rebel_speed_share * mean))
          by_velocity_.join(i, j);
      });
}

bool LinkLayering::reaches_too_high(std::span<const int> group, double w,
                                    const MotionField& field) const {
  if (!field.ground() || !(w > 0)) return false;
  const double ratio = w * field.reference_depth_m();
  return std::any_of(group.begin(), group.end(), [&](int i) {
    const double ground_ratio = *field.ground_ratio(nodes_[i].edge->location);
    return field.ground()->height_m * (1 - ground_ratio / ratio) > parameters_.max_size;
  });
}

void LinkLayering::make_square(std::span<const int> group, const MotionField& field) {
  const double n = static_cast<double>(group.size());
  Square square;
  hull_.clear();
  Vec2 velocity = Vec2::Zero(), origin = Vec2::Zero();
  double ratio = 0, speed = 0, weights = 0;
  const bool rebel = nodes_[group.front()].edge->rebel;
  for (const int i : group) {
    const Edge& edge = *nodes_[i].edge;
    hull_.add(edge.location);
    auto companion = std::lower_bound(companions_.begin(), companions_.end(), i,
                                      [](const Companion& c, int node) { return c.node < node; });
    for (; companion != companions_.end() && companion->node == i; ++companion) {
      hull_.add(companion->location);
    }
    const double weight = rebel ? 1 : 1 / (depths_[i].sigma * depths_[i].sigma);
    ratio += weight * (rebel ? edge.depth_ratio : depths_[i].w * field.reference_depth_m());
    weights += weight;
    speed += edge.speed / n;
    if (rebel) velocity += nodes_[i].velocity_pxps / n;
    origin += edge.origin / n;
  }
  const auto [low, high] = hull_.box();
  const Vec2 size = high - low;
  if (size.prod() < parameters_.min_area) return;
  const double w = ratio / weights / field.reference_depth_m();
  const double largest_px = parameters_.max_size * camera_.focal_px * w;
  if (!rebel && (size.maxCoeff() > largest_px || reaches_too_high(group, w, field))) return;
  square.location = 0.5 * (low + high);
  square.half_size = 0.5 * size;
  square.outline = hull_.outline();
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

const std::vector<Square>& LinkLayering::layer(const Layers& layers, const MotionField& field,
                                               std::span<const Follower> followers) {
  squares_.clear();
  gather(layers.normal_edges, parameters_.upward, field);
  link_by_depth();
  make_squares(by_depth_.sets(), static_cast<std::size_t>(parameters_.min_edges), field);
  gather(layers.rebel_edges, parameters_.rebel_upward, field);
  if (parameters_.followers) take_in(followers);
  link_by_velocity(field.dt_s());
  make_squares(by_velocity_, static_cast<std::size_t>(parameters_.min_rebels), field);
  return squares_;
}

}  // namespace lcs
