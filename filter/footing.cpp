#include "filter/footing.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "filter/geometry.h"
#include "filter/refill.h"

namespace lcs {
namespace {

/// However long its path, a depth is not known better than this share.
constexpr double kDepthFloor = 0.03;

/// Depths count that are known as well as this: a share of them, or 1/m.
constexpr double kKnownShare = 0.2, kKnown_1pm = 0.03;

/// Of the camera. Slower than this its own speed is known so badly, wheels err by some cm/s, that
/// all depths come out too large or too small together.
constexpr double kLeastSpeed_mps = 0.08;

/// Frames after which a path counts: what rain and flicker make is gone by then.
constexpr int kLeastAge = 3;

/// Share by which depths within a group may differ, beside their errors.
constexpr double kLikeDepth = 0.1;
double like_depth(double ratio) {
  return kLikeDepth * ratio;
}

/// Edges that are looked at round each, about.
constexpr double kCrowd = 64;

/// Of the grid: about as wide as so many neighbours lie apart.
constexpr double kCell_px = 32;

/// What a place at the end of the reach counts beside a depth at the end of its tolerance, squared.
constexpr double kApart = 3;

/// Edges that must be below the ground, and their share of those that see ground.
constexpr int kLeastSunk = 3;
constexpr double kSunkShare = 0.5;

/// px: how far off a line the stairs of pixels are that it is drawn as. Their corners slide along
/// it as it moves.
constexpr double kStairs_px = 1;

/// px: what lies as near to the side of the picture may go on beyond it; a few corners apart.
constexpr double kCut_px = 20;

/// px: how far beside a group something may stand that bears it.
constexpr double kBearerMargin_px = 5;
/// A bearer is at least as near as the group, but for this share.
constexpr double kBearerShare = 0.75;

}  // namespace

void Footing::gather(std::vector<Edge>& edges, const MotionField& field) {
  const UprightMetric upright{along_horizon_, parameters_.upward};
  const double known = kKnown_1pm * field.reference_depth_m();
  for (Edge& edge : edges) {
    if (edge.corner < 0 || edge.path.weight <= 0) continue;
    if (edge.unfounded == 0 && (edge.rebel || edge.age < kLeastAge)) continue;
    const double ratio = edge.path.ratio;
    const double sigma = std::max(kDepthFloor * ratio, edge.path.sigma());
    if (sigma > std::max(kKnownShare * ratio, known)) continue;
    nodes_.push_back({&edge, ratio, sigma, *field.ground_ratio(edge.location),
                      edge.location.dot(along_horizon_)});
    points_.push_back(upright(edge.location));
  }
}

/// Groups of edges near each other at one depth: best link first, while the means agree.
void Footing::link() {
  grid_.build(points_, kCell_px);
  depths_.reset(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    depths_.set_depth(i, nodes_[i].ratio, nodes_[i].sigma);
  }
  const double reach2 = parameters_.reach * parameters_.reach;
  depths_.link_near(
      grid_, kCrowd, [&](int) { return parameters_.reach; },
      [&](int i, int j, double apart2) {
        const Node &a = nodes_[i], &b = nodes_[j];
        const double difference = std::abs(a.ratio - b.ratio);
        const double like = like_depth(0.5 * (a.ratio + b.ratio));
        // Most are not alike at all; asked first, for it costs least.
        if (!(difference < like + a.sigma + b.sigma)) return 1.0;
        const double tolerance = like + std::sqrt(a.sigma * a.sigma + b.sigma * b.sigma);
        const double unlike = difference / tolerance;
        if (!(unlike < 1)) return 1.0;
        return (unlike * unlike + kApart * apart2 / reach2) / (1 + kApart);
      });
  depths_.merge_links(like_depth);
}

/// What stands one above the other at one depth is one body, however far apart: legs have no
/// corners.
void Footing::stack() {
  spans_.clear();
  refill(span_of_, nodes_.size(), -1);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const int root = depths_.sets().root(static_cast<int>(i));
    const double across = nodes_[i].across;
    if (span_of_[root] < 0) {
      span_of_[root] = static_cast<int>(spans_.size());
      spans_.push_back({root, 0, across, across});
    }
    Span& span = spans_[span_of_[root]];
    ++span.members;
    span.left = std::min(span.left, across);
    span.right = std::max(span.right, across);
  }
  std::erase_if(spans_, [](const Span& span) { return span.members < 2; });
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    for (std::size_t j = i + 1; j < spans_.size(); ++j) {
      const Span &p = spans_[i], &q = spans_[j];
      const double overlap = std::min(p.right, q.right) - std::max(p.left, q.left);
      if (overlap >= 0.5 * std::min(p.right - p.left, q.right - q.left))
        depths_.merge(p.root, q.root, like_depth);
    }
  }
}

Footing::Extent Footing::sunk(Group group) {
  int low = 0;
  below_.clear();
  Extent extent;
  for (const int i : group) {
    const Node& node = nodes_[i];
    if (node.ground < 2 * slack_) continue;
    ++low;
    if (!node.is_below_ground(slack_)) continue;
    below_.push_back(node.edge->location);
    const double overhang = overhang_px_ * node.ground;
    extent.add(node.across - overhang, node.across + overhang);
  }
  const auto below = static_cast<int>(below_.size());
  if (below < kLeastSunk || below < kSunkShare * low) return {};
  return most_on_a_line(below_, kStairs_px) < below_.size() ? extent : Extent();
}

/// Whether a group's foot is seen farther away than the group seems to be.
bool Footing::hangs(Group group) {
  values_.clear();
  for (const int i : group) values_.push_back(nodes_[i].ground);
  // The second lowest, so that one edge that does not belong says nothing: but if it does not lie
  // on the ground it belongs.
  const std::ptrdiff_t rank = values_.size() > 2 ? 1 : 0;
  std::nth_element(values_.begin(), values_.begin() + rank, values_.end(), std::greater<>());
  double foot = values_[rank];
  for (const int i : group) {
    if (nodes_[i].is_above_ground(slack_)) foot = std::max(foot, nodes_[i].ground);
  }
  if (foot < 2 * slack_) return false;
  return depths_.mean(depths_.sets().root(group.front())) > parameters_.lift * (foot + slack_);
}

/// Whether the picture's side may hide part of a group, its foot perhaps.
bool Footing::is_cut_off(Group group) const {
  const Vec2 beside = kCut_px * along_horizon_;
  return std::any_of(group.begin(), group.end(), [&](int i) {
    const Vec2& x = nodes_[i].edge->location;
    return !picture_.contain(x - beside) || !picture_.contain(x + beside);
  });
}

Footing::Extent Footing::aloft(Group group) {
  const int own = depths_.sets().root(group.front());
  if (!hanging_[own] || static_cast<int>(group.size()) < parameters_.members) return {};
  if (is_cut_off(group)) return {};
  // What has just come into view need not have shown its foot yet.
  const auto known = std::count_if(group.begin(), group.end(), [&](int i) {
    return nodes_[i].edge->unfounded > 0 || nodes_[i].edge->age > 2 * frames_;
  });
  if (2 * known < static_cast<std::ptrdiff_t>(group.size())) return {};
  Extent extent;
  double foot = nodes_[own].ground;
  for (const int i : group) {
    extent.add(nodes_[i].across, nodes_[i].across);
    foot = std::max(foot, nodes_[i].ground);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    if (hanging_[depths_.sets().root(static_cast<int>(i))]) continue;
    const bool below = node.ground > foot && node.across > extent.left - kBearerMargin_px &&
                       node.across < extent.right + kBearerMargin_px;
    if (below && node.ratio > kBearerShare * depths_.mean(own)) return {};
  }
  return extent;
}

/// An edge that is new to a group knows what the group knows.
void Footing::count(Group group, const Extent& unfounded) const {
  double known = 0;
  for (const int i : group) known += nodes_[i].edge->unfounded;
  const int mean = static_cast<int>(std::lround(known / static_cast<double>(group.size())));
  for (const int i : group) {
    int& frames = nodes_[i].edge->unfounded;
    frames = unfounded.holds(nodes_[i].across) ? std::min(2 * frames_, std::max(frames, mean) + 1)
                                               : std::max(0, frames - 1);
  }
}

void Footing::judge(std::vector<Edge>& normals, std::vector<Edge>& rebels,
                    const MotionField& field) {
  const auto along_horizon = field.along_horizon();
  if (parameters_.time <= 0 || !along_horizon || !field.moving()) return;
  if (field.displacement_C_m().norm() < kLeastSpeed_mps * field.dt_s()) return;
  along_horizon_ = *along_horizon;
  frames_ = std::max(kLeastFrames, static_cast<int>(std::lround(parameters_.time / field.dt_s())));
  slack_ = field.ground_slack();
  overhang_px_ = field.length_px(parameters_.overhang);
  nodes_.clear();
  points_.clear();
  gather(normals, field);
  gather(rebels, field);
  link();
  stack();
  groups_.collect(depths_.sets(), [](std::size_t) { return true; });
  refill(hanging_, nodes_.size());
  groups_.visit([&](Group group) { hanging_[depths_.sets().root(group.front())] = hangs(group); });
  groups_.visit([&](Group group) {
    Extent unfounded = sunk(group);
    if (unfounded.is_empty()) unfounded = aloft(group);
    count(group, unfounded);
  });
}

}  // namespace lcs
