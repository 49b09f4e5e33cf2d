#include "filter/comers/comers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "filter/circles/mean_circle.h"
#include "filter/circles/motion_groups.h"
#include "filter/edges/gauss.h"
#include "filter/kinematics/geometry.h"
#include "filter/matching/refill.h"

namespace lcs {
namespace {

/// Unit vector of the image to the right along the ground's horizon; downward is its normal.
Vec2 along_axis(const Vec2& up_xy) {
  return Vec2(-up_xy.y(), up_xy.x()).normalized();
}

bool is_known(const Edge& edge) {
  return edge.corner >= 0 && has_depth(edge);
}

}  // namespace

void Comers::find_ground_coordinates(const std::vector<Edge>& edges, const MotionField& field) {
  const Ground& ground = *field.ground();
  const Vec2 axis = along_axis(ground.up_C.head<2>());
  const double slack_pm = field.ground_slack() / field.reference_depth_m();
  seen_.clear();
  make_room(seen_, edges.size());
  for (const Edge& edge : edges) {
    const Vec2 h = (edge.location - camera_.centre_px) / camera_.focal_px;
    Seen seen;
    seen.inverse_depth_pm = edge.depth_ratio / field.reference_depth_m();
    seen.sigma_pm = edge.depth_ratio_sigma / field.reference_depth_m();
    seen.down = -ground.up_C.dot(h.homogeneous());
    seen.along = axis.dot(h);
    seen.seen = edge.corner >= 0 && std::isfinite(seen.sigma_pm);
    const double ground_pm = seen.down / ground.height_m;
    const Eigen::Vector3d sigmas(seen.sigma_pm, slack_pm, circle_.roughness * ground_pm);
    seen.ground = std::abs(seen.inverse_depth_pm - ground_pm) < 2 * sigmas.norm();
    seen_.push_back(seen);
  }
}

/// Log likelihood ratio of a circle: it comes / it stands or hangs; 0 if nothing can be told.
double Comers::evidence(Id circle, std::span<const int> members, const MotionField& field,
                        GapView& view) {
  const Ground& ground = *field.ground();
  const Vec2 up = ground.up_C.head<2>();
  const double n = static_cast<double>(members.size());
  const double f = camera_.focal_px;

  depths_.clear();
  make_room(depths_, members.size());
  double foot = -std::numeric_limits<double>::infinity(), top = -foot, left = -foot, right = foot;
  for (const int i : members) {
    const Seen& seen = seen_[i];
    depths_.push_back(seen.inverse_depth_pm);
    foot = std::max(foot, seen.down);
    top = std::min(top, seen.down);
    left = std::min(left, seen.along);
    right = std::max(right, seen.along);
  }
  const auto middle = depths_.begin() + std::ssize(depths_) / 2;
  std::nth_element(depths_.begin(), middle, depths_.end());
  const double W = *middle;

  // The foot may be hidden by anything that is neither the ground nor farther than the circle.
  const double margin = circle_.gap_m * W;
  double lowest = foot;
  for (const Seen& seen : seen_) {
    const bool is_below = seen.seen && !seen.ground && seen.down > lowest &&
                          seen.down < W * ground.height_m && seen.along > left - margin &&
                          seen.along < right + margin;
    if (!is_below) continue;
    const double farther = W - seen.inverse_depth_pm;
    const bool is_level =
        std::abs(farther) < 2 * std::hypot(seen.sigma_pm, circle_.roughness * W);
    if (is_level || farther < -2 * seen.sigma_pm) lowest = seen.down;
  }
  foot = lowest;

  // The height of the foot above the ground, in heights of the camera.
  const double q = 1 - foot / (ground.height_m * W);
  const double bottom = -ground.up_C.dot(
      Vec2((Vec2(camera_.centre_px.x(), camera_.height_px - 1) - camera_.centre_px) / f)
          .homogeneous());
  const double stop = std::min(W * ground.height_m, bottom);
  if (!(q > 0 && q < 1 && stop > foot)) return 0;
  const double speed_mps = field.displacement_C_m().norm() / field.dt_s();
  const double speed_share = std::hypot(field.velocity_sigma_mps() / speed_mps, edge_.ego_share);
  const double slack_pm = field.ground_slack() / field.reference_depth_m();
  const double z =
      q / Eigen::Vector3d(slack_pm / W, circle_.roughness, (1 - q) * speed_share).norm();
  if (z < 1) return 0;

  // Widened to the body's expected size.
  const double wider = (right - left) / (n - 1) + 2 / f;
  const double px_per_down = f / up.norm();
  Gap gap;
  gap.circle = circle;
  gap.across = along_axis(up);
  gap.inverse_depth_pm = W;
  gap.columns = static_cast<int>((right - left + 2 * wider) * f);
  gap.rows = static_cast<int>((stop - foot) * px_per_down) - 2;
  gap.place_px = camera_.centre_px + f * ((left - wider) * gap.across) +
                 ((foot + ground.up_C.z()) * px_per_down + 2) * -up.normalized();
  if (gap.columns < 1 || gap.rows < 1) return 0;
  const std::optional<double> picture = view.evidence(gap);
  if (!picture) return 0;
  result_.gaps.push_back({gap, *picture});

  const double empty = (stop - foot) / (stop - top);
  const double corners = -std::pow(n, parameters_.count_power) * std::log1p(-empty);
  return -std::log(std::exp(-0.5 * z * z) + std::exp(-corners - *picture) + parameters_.hanging);
}

/// Updates the log odds of all edges by those of their circles.
void Comers::believe(const std::vector<Edge>& edges, const CircleExpert::Result& circles,
                     const MotionField& field, GapView& view) {
  const double prior = log_odds(edge_.prior);
  next_.clear();
  make_room(next_, edges.size());
  auto before = beliefs_.begin();
  for (const Edge& edge : edges) {
    while (before != beliefs_.end() && before->edge < edge.id) ++before;
    const bool is_old = before != beliefs_.end() && before->edge == edge.id;
    next_.push_back({edge.id, is_old ? before->log_odds : prior});
  }
  beliefs_.swap(next_);

  const std::vector<int>& of_edges = circles.of_edges.normal;
  const std::size_t count = circles.circles.normal.size();
  refill(first_, count + 2);
  for (const int c : of_edges) ++first_[c + 2];  // those without a circle come first
  for (std::size_t c = 2; c < first_.size(); ++c) first_[c] += first_[c - 1];
  refill(grouped_, of_edges.size());
  for (std::size_t i = 0; i < of_edges.size(); ++i) {
    grouped_[first_[of_edges[i] + 1]++] = static_cast<int>(i);
  }
  refill(moves_, edges.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < count; ++c) {
    const std::span<const int> members(grouped_.data() + first_[c], grouped_.data() + first_[c + 1]);
    double mean = 0;
    for (const int i : members) mean += beliefs_[i].log_odds;
    mean /= static_cast<double>(members.size());
    const double now = evidence(circles.circles.normal[c].id, members, field, view) + prior;
    const double belief = mean + (now - mean) / parameters_.memory;
    for (const int i : members) moves_[i] = beliefs_[i].log_odds = belief;
  }
}

/// An edge without a known depth, and a corner without an edge, follow the nearest edge with one.
void Comers::inherit(const std::vector<Edge>& edges, std::span<const Eigen::Vector2f> corners_px,
                     std::span<const Reason> reasons) {
  known_.clear();
  places_.clear();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!is_known(edges[i])) continue;
    known_.push_back(static_cast<int>(i));
    places_.push_back(edges[i].location);
  }
  const double reach_px = edge_.neighbour_reach_px;
  grid_.build(places_, reach_px);
  const auto odds_near = [&](const Vec2& x) {
    Neighbour nearest{reach_px * reach_px, -1};
    grid_.visit_within(x, reach_px, [&](int k, double distance2) {
      nearest = std::min(nearest, {distance2, k});
    });
    return nearest.index < 0 ? 0 : moves_[known_[nearest.index]];
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].corner >= 0 && !is_known(edges[i])) moves_[i] = odds_near(edges[i].location);
  }
  for (std::size_t c = 0; c < corners_px.size(); ++c) {
    if (reasons[c] != Reason::first_sighting) continue;
    if (odds_near(corners_px[c].cast<double>()) > 0) {
      result_.inherited.push_back(static_cast<int>(c));
    }
  }
}

/// The edges and circles with the called ones among the rebels.
void Comers::relabel(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
                     const MotionField& field) {
  auto& [to, to_circles, called, inherited, gaps] = result_;
  const auto& [normal, rebel] = circles.circles;
  // The place of each normal circle among its new kind; its members agree.
  refill(place_, normal.size(), -1);
  for (std::size_t i = 0; i < edges.normal.size(); ++i) {
    const int c = circles.of_edges.normal[i];
    if (c >= 0 && moves_[i] > 0) place_[c] = 0;
  }
  copy_over(rebel, to_circles.circles.rebel);
  to_circles.circles.normal.clear();
  for (std::size_t c = 0; c < normal.size(); ++c) {
    std::vector<Circle>& kind = place_[c] < 0 ? to_circles.circles.normal : to_circles.circles.rebel;
    place_[c] = static_cast<int>(kind.size());
    kind.push_back(normal[c]);
  }
  to.normal.clear();
  to.rebel.clear();
  to_circles.of_edges.normal.clear();
  to_circles.of_edges.rebel.clear();
  const auto add_rebel = [&](const Edge& edge, int circle) {
    to.rebel.push_back(edge);
    to_circles.of_edges.rebel.push_back(circle);
  };
  std::size_t r = 0;
  for (std::size_t i = 0; i < edges.normal.size(); ++i) {
    const int c = circles.of_edges.normal[i];
    const int circle = c < 0 ? -1 : place_[c];
    Edge edge = edges.normal[i];
    if (!(moves_[i] > 0)) {
      to.normal.push_back(edge);
      to_circles.of_edges.normal.push_back(circle);
      continue;
    }
    for (; r < edges.rebel.size() && edges.rebel[r].id < edge.id; ++r) {
      add_rebel(edges.rebel[r], circles.of_edges.rebel[r]);
    }
    edge.rebel = true;
    edge.origin = edge.location - field.dt_s() * edge.velocity();
    edge.depth_ratio_sigma = std::numeric_limits<double>::infinity();
    edge.trust = circle_.trust.of_certainty(moves_[i]);
    called.push_back(edge.corner);
    add_rebel(edge, circle);
  }
  for (; r < edges.rebel.size(); ++r) add_rebel(edges.rebel[r], circles.of_edges.rebel[r]);

  for (std::size_t c = rebel.size(); c < to_circles.circles.rebel.size(); ++c) {
    Circle& circle = to_circles.circles.rebel[c];
    members_.clear();
    for (std::size_t i = 0; i < to.rebel.size(); ++i) {
      if (to_circles.of_edges.rebel[i] == static_cast<int>(c)) members_.push_back(static_cast<int>(i));
    }
    Circle mean = mean_circle(to.rebel, members_, field);
    mean.id = circle.id;
    mean.trust = circle.trust;
    mean.age = circle.age;
    circle = mean;
  }
}

const Comers::Result* Comers::step(const BothKinds<Edge>& edges,
                                   const CircleExpert::Result& circles,
                                   std::span<const Eigen::Vector2f> corners_px,
                                   std::span<const Reason> reasons, const MotionField& field,
                                   GapView& view) {
  result_.called.clear();
  result_.inherited.clear();
  result_.gaps.clear();
  if (!field.ground() || !field.moving() || field.ground()->up_C.head<2>().isZero()) return nullptr;
  find_ground_coordinates(edges.normal, field);
  believe(edges.normal, circles, field, view);
  const bool is_any = std::ranges::any_of(moves_, [](double odds) { return odds > 0; });
  if (is_any) inherit(edges.normal, corners_px, reasons);
  relabel(edges, circles, field);
  return &result_;
}

}  // namespace lcs
