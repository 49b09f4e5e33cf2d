#include "filter/radial/radial_movers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "filter/circles/motion_groups.h"
#include "filter/edges/gauss.h"
#include "filter/radial/median.h"
#include "filter/vectors/refill.h"

namespace lcs {
namespace {

bool is_known(const Edge& edge) {
  return edge.corner >= 0 && has_depth(edge);
}

}  // namespace

/// Log likelihood ratio of a circle: it comes / it stands or hangs; 0 if nothing can be told.
double Comers::evidence(Id circle, std::span<const int> members, const RadialFrame& frame,
                        GapView& view) {
  if (parameters_.hanging >= 1) return 0;  // nothing could speak for a comer
  const GroundView& ground = frame.ground;
  depths_pm_.clear();
  double foot = -std::numeric_limits<double>::infinity(), top = -foot, left = -foot, right = foot;
  for (const int i : members) {
    const GroundEdge& edge = frame.seen[i];
    depths_pm_.push_back(edge.inverse_depth_pm);
    foot = std::max(foot, edge.down);
    top = std::min(top, edge.down);
    left = std::min(left, edge.along);
    right = std::max(right, edge.along);
  }
  const double W = median(depths_pm_);
  const double stands_down = ground.ground_down(W);  // of a foot that stands

  // The foot may be hidden by anything that is neither the ground nor farther than the circle.
  const double margin = circle_.gap_m * W;
  double lowest = foot;
  for (const GroundEdge& edge : frame.seen) {
    const bool is_below = edge.is_seen && !edge.is_ground && edge.down > lowest &&
                          edge.down < stands_down && edge.along > left - margin &&
                          edge.along < right + margin;
    if (!is_below) continue;
    const double farther = W - edge.inverse_depth_pm;
    const bool is_level = std::abs(farther) < 2 * std::hypot(edge.sigma_pm, circle_.roughness * W);
    if (is_level || farther < -2 * edge.sigma_pm) lowest = edge.down;
  }
  foot = lowest;

  const double q = 1 - foot / stands_down;  // height of the foot, in heights of the camera
  const double stop = std::min(stands_down, ground.lowest());
  if (!(q > 0 && q < 1 && stop > foot)) return 0;
  const double speed_mps = frame.field.displacement_C_m().norm() / frame.field.dt_s();
  const double speed_share =
      std::hypot(frame.field.velocity_sigma_mps() / speed_mps, edge_.ego_share);
  const Eigen::Vector3d sigmas(ground.slack_pm() / W, circle_.roughness, (1 - q) * speed_share);
  const double z = q / sigmas.norm();
  if (z < 1) return 0;

  // As wide as the body is expected to be, as in (25), and a pixel of FAST's circle more.
  const double n = static_cast<double>(members.size());
  const double wider = (right - left) / (n - 1) + 2 / camera_.focal_px;
  Gap gap;
  gap.circle = circle;
  gap.across = ground.across();
  gap.inverse_depth_pm = W;
  gap.columns = static_cast<int>((right - left + 2 * wider) * camera_.focal_px);
  gap.rows = static_cast<int>((stop - foot) * ground.px_per_down()) - 2;
  gap.place_px = ground.place_px(left - wider, foot + 2 / ground.px_per_down());
  if (gap.columns < 1 || gap.rows < 1) return 0;
  const std::optional<double> picture = view.evidence(gap);
  if (!picture) return 0;
  result_.gaps.push_back({gap, *picture});

  const double empty = (stop - foot) / (stop - top);
  const double corners = -std::pow(n, parameters_.count_power) * std::log1p(-empty);
  return -std::log(std::exp(-0.5 * z * z) + std::exp(-corners - *picture) + parameters_.hanging);
}

/// Takes the log odds of the edges from the last frame; new edges have the prior's log odds.
void Comers::recall(const std::vector<Edge>& edges) {
  next_.clear();
  make_room(next_, edges.size());
  auto before = beliefs_.begin();
  for (const Edge& edge : edges) {
    while (before != beliefs_.end() && before->edge < edge.id) ++before;
    const bool is_old = before != beliefs_.end() && before->edge == edge.id;
    next_.push_back({edge.id, is_old ? before->log_odds : log_odds(edge_.prior)});
  }
  beliefs_.swap(next_);
}

void Comers::believe(const RadialFrame& frame, GapView& view) {
  const std::vector<Circle>& normal = frame.circles.circles.normal;
  members_.collect(frame.circles.of_edges.normal, normal.size());
  refill(result_.odds, frame.seen.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < normal.size(); ++c) {
    const std::span<const int> members = members_.of(c);
    double before = 0;
    for (const int i : members) before += beliefs_[i].log_odds;
    before /= static_cast<double>(members.size());
    const double now = log_odds(edge_.prior) + evidence(normal[c].id, members, frame, view);
    const double belief = before + (now - before) / parameters_.memory;
    for (const int i : members) result_.odds[i] = beliefs_[i].log_odds = belief;
  }
}

/// An edge without a known depth, and a corner without an edge, follow the nearest edge with one.
void Comers::inherit(const RadialFrame& frame) {
  const std::vector<Edge>& edges = frame.edges.normal;
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
    return nearest.index < 0 ? 0 : result_.odds[known_[nearest.index]];
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].corner >= 0 && !is_known(edges[i])) result_.odds[i] = odds_near(edges[i].location);
  }
  for (std::size_t c = 0; c < frame.corners_px.size(); ++c) {
    if (frame.reasons[c] != Reason::first_sighting) continue;
    const double odds = odds_near(frame.corners_px[c].cast<double>());
    if (odds > 0) result_.inherited.push_back({static_cast<int>(c), static_cast<float>(odds)});
  }
}

const Comers::Result& Comers::step(const RadialFrame& frame, GapView& view) {
  result_.inherited.clear();
  result_.gaps.clear();
  recall(frame.edges.normal);
  believe(frame, view);
  if (std::ranges::any_of(result_.odds, [](double odds) { return odds > 0; })) inherit(frame);
  return result_;
}

}  // namespace lcs
