/// \file
/// How a rover moves that is given places and times in place of commands.
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::sim {

/// Straight and uniform from each waypoint to the next, as something with mass can follow it: both
/// the velocity and the heading change in a time round each waypoint, half of it before, half
/// behind.
///
/// A change of velocity by dv takes |dv| / 5 m/s^2 (`SmoothCommand` has the limits), so that a bend
/// is rounded by |dv|^2 / 40 m/s^2: 12 mm for a right angle at 0.5 m/s. The rover looks where it
/// goes. It turns at up to 60 deg/s, and so looks aside of its way round a sharp bend; while it
/// stands between two waypoints of one place, it turns on the spot. Where the waypoints leave less
/// time than that (half of the shorter leg on either side), all of it is taken and the limits are
/// exceeded. It is under way at 0 if the first waypoint is at 0, and stands behind the last one.
class Route {
 public:
  static constexpr double kMaxYawRate_radps = std::numbers::pi / 3;

  /// \param ego with waypoints.
  /// \throws scenario::Error at a waypoint that nothing could pass as fast.
  explicit Route(const scenario::Ego& ego);

  struct Motion {
    Eigen::Vector2d velocity_W_mps;
    double yaw_rate_radps;  ///< ccw
  };
  Motion at(double t_s) const;

 private:
  /// From one velocity to another, evenly.
  struct Change {
    double from_s, to_s;
    Eigen::Vector2d before_mps, after_mps;
  };
  /// By an angle, with a rate that grows from 0 and falls to 0 again.
  struct Turn {
    double from_s, to_s, by_rad;
  };

  std::vector<Change> changes_;  ///< in order of time, one for each waypoint
  std::vector<Turn> turns_;      ///< likewise, where the way bends
};

}  // namespace lcs::sim
