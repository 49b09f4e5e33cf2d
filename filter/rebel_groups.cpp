#include "filter/rebel_groups.h"

#include <algorithm>
#include <cmath>

#include "filter/geometry.h"
#include "filter/refill.h"

namespace lcs {
namespace {

/// Share of a group that lies on one line if it is an outline's crossings.
constexpr double kInLine = 0.8;

/// How far behind a rebel its origin is kept, in steps, so that beta is its direction of now.
constexpr double kOriginSteps = 5;

/// Rebels of one group differ by less than this, or this share of their steps, px.
constexpr double kLikeStep_px = 1.0, kLikeStepShare = 0.2;

/// Edges that are looked at round each, about, where more are near.
constexpr double kCrowd = 96;

/// Of the grid.
constexpr double kCell_px = 32;

/// The middle value, of an even number the mean of the middle two, so that -x has the median -m.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

void set_velocity(Edge& edge, const Vec2& velocity_pxps, double dt_s) {
  edge.speed = velocity_pxps.norm();
  if (edge.speed > 0) edge.angle = angle_of(velocity_pxps);
  edge.origin = edge.location - kOriginSteps * dt_s * velocity_pxps;
}

void RebelGroups::judge(std::vector<Edge>& rebels, double dt_s) {
  connect(rebels, dt_s);
  groups_.collect(components_, [&](std::size_t i) { return trust_.alive(rebels[i].trust); });
  support(rebels);
  smooth(rebels, dt_s);
}

/// Connected components of edges near each other and of like velocity.
void RebelGroups::connect(const std::vector<Edge>& rebels, double dt_s) {
  points_.clear();
  steps_.clear();
  lengths_px_.clear();
  for (const Edge& edge : rebels) {
    points_.push_back(edge.location);
    steps_.push_back(edge.velocity() * dt_s);
    lengths_px_.push_back(edge.speed * dt_s);
  }
  grid_.build(points_, kCell_px);
  components_.reset(rebels.size());
  grid_.visit_crowd_pairs(
      kCrowd, [&](int) { return parameters_.radius; },
      [&](int i, int j, double) {
        const double mean_px = 0.5 * (lengths_px_[i] + lengths_px_[j]);
        const double like_px = std::max(kLikeStep_px, kLikeStepShare * mean_px);
        if (!((steps_[i] - steps_[j]).squaredNorm() < like_px * like_px)) return;
        if (components_.are_joined(i, j)) return;
        if (trust_.alive(rebels[i].trust) && trust_.alive(rebels[j].trust)) components_.join(i, j);
      });
}

/// Where an outline hides a pattern behind it, their crossings move as neither does, but in line
/// along the outline; some beside it get in with them. What stands on nothing is a body, legs or
/// poles perhaps.
bool RebelGroups::is_in_line(const std::vector<Edge>& rebels, std::span<const int> group) {
  places_.clear();
  for (const int i : group) {
    if (rebels[i].unfounded > 0) return false;
    places_.push_back(rebels[i].location);
  }
  const std::size_t most = most_on_a_line(places_, parameters_.support_width);
  return static_cast<double>(most) >= kInLine * static_cast<double>(group.size());
}

void RebelGroups::support_group(const std::vector<Edge>& rebels, std::span<const int> group) {
  if (static_cast<int>(group.size()) < parameters_.support) return;
  const bool in_line = is_in_line(rebels, group);
  for (const int i : group) {
    const auto& [near, off] = bearers_[i];
    const bool moves = off >= parameters_.support_off_field * near;
    stray_[i] = (in_line || !moves) && rebels[i].age >= 2;
    if (near < parameters_.support) continue;
    reasons_[i] = !moves    ? Reason::rebel_on_field
                  : in_line ? Reason::rebel_in_line
                            : Reason::rebel_edge;
  }
}

void RebelGroups::support(std::vector<Edge>& rebels) {
  refill(reasons_, rebels.size(), Reason::rebel_alone);
  refill(stray_, rebels.size());
  refill(bearers_, rebels.size());
  refill(group_of_, rebels.size());
  refill(is_off_, rebels.size());
  for (std::size_t i = 0; i < rebels.size(); ++i) {
    group_of_[i] = components_.root(static_cast<int>(i));
    is_off_[i] = rebels[i].off_field_px > kOffField_px;
    bearers_[i] = {1, is_off_[i]};
  }
  grid_.visit_crowd_pairs(
      kCrowd, [&](int) { return parameters_.radius; },
      [&](int i, int j, double) {
        if (group_of_[i] != group_of_[j]) return;
        ++bearers_[i].near;
        ++bearers_[j].near;
        bearers_[i].off += is_off_[j];
        bearers_[j].off += is_off_[i];
      });
  groups_.visit([&](std::span<const int> group) { support_group(rebels, group); });
  for (std::size_t i = 0; i < rebels.size(); ++i) {
    if (stray_[i]) rebels[i].trust -= 2;
  }
}

/// A shift and a change of size are fitted to the velocities of each group, and pull them; an edge
/// that is far off the fit loses trust.
void RebelGroups::smooth_group(std::vector<Edge>& rebels, std::span<int> group, double dt_s) {
  const auto dead = std::remove_if(group.begin(), group.end(),
                                   [&](int i) { return !trust_.alive(rebels[i].trust); });
  group = group.first(static_cast<std::size_t>(dead - group.begin()));
  if (group.size() < 4) return;
  vx_.clear();
  vy_.clear();
  Vec2 centre = Vec2::Zero();
  for (const int i : group) {
    const Vec2 step = rebels[i].velocity() * dt_s;
    centre += rebels[i].location;
    vx_.push_back(step.x());
    vy_.push_back(step.y());
  }
  centre /= static_cast<double>(group.size());
  const Vec2 shift(median(vx_), median(vy_));
  const double tolerance = 3 + 0.3 * shift.norm();
  double growth = 0;
  if (group.size() >= 5) {
    double numerator = 0, denominator = 1;
    for (const int i : group) {
      const Vec2 arm = rebels[i].location - centre;
      const Vec2 rest = rebels[i].velocity() * dt_s - shift;
      if (rest.norm() > tolerance) continue;
      numerator += arm.dot(rest);
      denominator += arm.squaredNorm();
    }
    growth = numerator / denominator;
  }
  for (const int i : group) {
    const Vec2 fitted = shift + growth * (rebels[i].location - centre);
    const Vec2 step = rebels[i].velocity() * dt_s;
    if ((step - fitted).norm() > tolerance && rebels[i].corner >= 0) --rebels[i].trust;
    const double faster = 1 + std::clamp(growth, -0.2, 0.3);
    set_velocity(rebels[i], faster * (0.4 * step + 0.6 * fitted) / dt_s, dt_s);
  }
}

void RebelGroups::smooth(std::vector<Edge>& rebels, double dt_s) {
  groups_.visit([&](std::span<int> group) { smooth_group(rebels, group, dt_s); });
}

}  // namespace lcs
