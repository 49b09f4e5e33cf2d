#include "sim/world/route.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/world/rover.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using scenario::Waypoint;

// Values beyond these are probably mistakes. They equal the bounds of `ego.acceleration`,
// `ego.yaw_rate` and `ego.speed`.
constexpr double kFastest_mps = 100;
constexpr double kHardest_mps2 = 100;
constexpr double kFastestTurn_radps = 4 * std::numbers::pi;

// For a rate profile s (1 - s): the ratio of peak rate to mean rate, and of the acceleration at the
// ends to angle / time^2.
constexpr double kPeak = 1.5;
constexpr double kSteepest = 6;

double direction(const Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

/// \param is_it the impossible action, for example "drive at 300 m/s (at most 100)".
[[noreturn]] void refuse(const scenario::Ego& ego, std::size_t waypoint, const std::string& is_it) {
  throw input::Error(ego.source,
                     "at ego.waypoints.{} the rover would have to {}; give it more time", waypoint,
                     is_it);
}

}  // namespace

Route::Route(const scenario::Ego& ego) {
  const std::vector<Waypoint>& points = ego.waypoints;
  const std::size_t last = points.size() - 1;
  constexpr double kForever = std::numeric_limits<double>::infinity();
  // of the leg that begins at waypoint i
  const auto time_s = [&](std::size_t i) { return points[i + 1].at_s - points[i].at_s; };
  const auto velocity = [&](std::size_t i) {
    return Vector2d((points[i + 1].position_m - points[i].position_m) / time_s(i));
  };

  for (std::size_t i = 0; i <= last; ++i) {
    const bool is_under_way = i == 0 && points[0].at_s == 0;
    const Vector2d after = i < last ? velocity(i) : Vector2d::Zero();
    const Vector2d before = is_under_way ? after : i > 0 ? velocity(i - 1) : Vector2d::Zero();
    if (after.norm() > kFastest_mps) {
      refuse(ego, i, fmt::format("drive at {:g} m/s (at most {:g})", after.norm(), kFastest_mps));
    }
    const double change = (after - before).norm();
    const double room_s =
        std::min(i > 0 ? time_s(i - 1) : 2 * points[0].at_s, i < last ? time_s(i) : kForever);
    const double takes_s = std::min(room_s, change / SmoothCommand::kMaxAcceleration_mps2);
    if (change > kHardest_mps2 * takes_s) {
      refuse(ego, i,
             fmt::format("change its velocity by {:.3g} m/s within {:.3g} s (at most {:g} m/s^2)",
                         change, takes_s, kHardest_mps2));
    }
    changes_.push_back({points[i].at_s - takes_s / 2, points[i].at_s + takes_s / 2, before, after});
  }

  std::size_t arrived = last;  // end waypoint of the last leg with a motion
  for (std::size_t i = 0; i < last; ++i) {
    if (velocity(i).isZero(0)) continue;
    if (arrived <= i) {
      const bool is_pause = arrived < i;
      const double by = std::remainder(direction(velocity(i)) - direction(velocity(arrived - 1)),
                                       2 * std::numbers::pi);
      const double room_s =
          is_pause ? points[i].at_s - points[arrived].at_s : std::min(time_s(i - 1), time_s(i));
      const double takes_s =
          std::min(room_s, std::max(kPeak * std::abs(by) / kMaxYawRate_radps,
                                    std::sqrt(kSteepest * std::abs(by) /
                                              SmoothCommand::kMaxYawAcceleration_radps2)));
      if (kPeak * std::abs(by) > kFastestTurn_radps * takes_s) {
        refuse(ego, i,
               fmt::format("turn by {:.3g} deg within {:.3g} s (at most {:g} deg/s)",
                           std::abs(by) * 180 / std::numbers::pi, takes_s,
                           kFastestTurn_radps * 180 / std::numbers::pi));
      }
      const double middle_s = (points[arrived].at_s + points[i].at_s) / 2;
      if (by != 0) turns_.push_back({middle_s - takes_s / 2, middle_s + takes_s / 2, by});
    }
    arrived = i + 1;
  }
}

Route::Motion Route::at(double t_s) const {
  const auto latest = [&](const auto& all) {
    const auto later =
        std::ranges::upper_bound(all, t_s, {}, [](const auto& one) { return one.from_s; });
    return later == all.begin() ? nullptr : &*std::prev(later);
  };
  Motion motion{changes_.front().before_mps, 0};
  if (const Change* change = latest(changes_)) {
    const double share =
        t_s >= change->to_s ? 1 : (t_s - change->from_s) / (change->to_s - change->from_s);
    motion.velocity_W_mps = change->before_mps + share * (change->after_mps - change->before_mps);
  }
  if (const Turn* turn = latest(turns_); turn && t_s < turn->to_s) {
    const double takes_s = turn->to_s - turn->from_s;
    const double share = (t_s - turn->from_s) / takes_s;
    motion.yaw_rate_radps = kSteepest * share * (1 - share) * turn->by_rad / takes_s;
  }
  return motion;
}

}  // namespace lcs::sim
