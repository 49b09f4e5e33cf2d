#include "sim/world/actor.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

namespace lcs::sim {
namespace {

using scenario::Circular;
using scenario::Line;
using scenario::Still;
using scenario::Waypoint;
using scenario::Waypoints;

Eigen::Vector2d direction(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

/// Distance along a line; the speed stays 0 once it reaches 0.
double distance(const Line& line, double t) {
  const double a = line.acceleration_mps2;
  if (a < 0) t = std::min(t, -line.speed_mps / a);
  return line.speed_mps * t + a * t * t / 2;
}

PlanarPose at(const Still& still, const PlanarPose& home, double) {
  return {still.position_m.value_or(home.position_m), still.heading_rad.value_or(home.heading_rad),
          0};
}

PlanarPose at(const Line& line, const PlanarPose& home, double t) {
  const double heading = line.heading_rad.value_or(home.heading_rad);
  const double walked_m = distance(line, t);
  return {line.from_m.value_or(home.position_m) + walked_m * direction(heading), heading, walked_m};
}

/// Heading of the leg that ends at waypoint `end`. For a pause: of the last moving leg before it,
/// or, at the beginning, of the first moving leg after it.
double heading_on(const Waypoints& points, std::size_t end, double home_heading_rad) {
  const auto leg = [&](std::size_t i) {
    return Eigen::Vector2d(points[i].position_m - points[i - 1].position_m);
  };
  for (std::size_t i = end; i >= 1; --i) {
    if (!leg(i).isZero()) return std::atan2(leg(i).y(), leg(i).x());
  }
  for (std::size_t i = end + 1; i < points.size(); ++i) {
    if (!leg(i).isZero()) return std::atan2(leg(i).y(), leg(i).x());
  }
  return home_heading_rad;
}

/// The end of the leg at time t, and the share of it that is past. Before the first waypoint it is
/// the first leg, after the last one the last leg.
template <class Point>
std::pair<std::size_t, double> leg_at(const std::vector<Point>& points, double t) {
  const auto later = std::ranges::upper_bound(points, t, {}, &Point::at_s);
  const auto end = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(std::distance(points.begin(), later), 1, std::ssize(points) - 1));
  const double begin_s = points[end - 1].at_s;
  return {end, std::clamp((t - begin_s) / (points[end].at_s - begin_s), 0.0, 1.0)};
}

PlanarPose at(const Waypoints& points, const PlanarPose& home, double t) {
  const auto [end, share] = leg_at(points, t);
  const Waypoint& a = points[end - 1];
  const Waypoint& b = points[end];
  double walked_m = share * (b.position_m - a.position_m).norm();
  for (std::size_t i = 1; i < end; ++i) {
    walked_m += (points[i].position_m - points[i - 1].position_m).norm();
  }
  return {a.position_m + share * (b.position_m - a.position_m),
          heading_on(points, end, home.heading_rad), walked_m};
}

PlanarPose at(const Circular& circle, const PlanarPose&, double t) {
  const double angle = circle.start_angle_rad + circle.speed_mps / circle.radius_m * t;
  const double ahead = circle.speed_mps < 0 ? -std::numbers::pi / 2 : std::numbers::pi / 2;
  return {circle.centre_m + circle.radius_m * direction(angle), angle + ahead,
          std::abs(circle.speed_mps) * t};
}

}  // namespace

PlanarPose pose_on(const scenario::Trajectory& trajectory, const PlanarPose& home, double seconds) {
  const double t = std::max(0.0, seconds);
  return std::visit([&](const auto& kind) { return at(kind, home, t); }, trajectory);
}

JointState joint_at(const std::vector<scenario::JointPoint>& points, double seconds) {
  const auto [end, share] = leg_at(points, seconds);
  const scenario::JointPoint &a = points[end - 1], &b = points[end];
  const bool moves = a.at_s <= seconds && seconds < b.at_s;
  return {a.value + share * (b.value - a.value),
          moves ? (b.value - a.value) / (b.at_s - a.at_s) : 0};
}

double Trigger::update(std::int64_t t_ns, double ego_distance_m) {
  const double t = 1e-9 * static_cast<double>(t_ns);
  if (!start_s_ && t >= conditions_.at_s) {
    if (!conditions_.ego_within_m) {
      start_s_ = conditions_.at_s;  // exact, independent of the time steps
    } else if (ego_distance_m <= *conditions_.ego_within_m) {
      start_s_ = t;
    }
  }
  return start_s_ ? t - *start_s_ : -1.0;
}

}  // namespace lcs::sim
