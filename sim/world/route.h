/// \file
/// The motion of a rover that follows waypoints with times instead of velocity commands.
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::sim {

/// Straight legs at constant speed between waypoints, with limited accelerations: the changes of
/// velocity and heading are centred in time on the waypoint.
///
/// A change of velocity by dv takes |dv| / 5 m/s^2 (`SmoothCommand` has the limits). It rounds a
/// bend by |dv|^2 / 40 m/s^2: 12 mm for a right angle at 0.5 m/s. The rover faces its direction of
/// travel but turns at 60 deg/s at most, so that its heading deviates from its path for a while in
/// a sharp bend. Between two waypoints at one position it turns on the spot. Where the waypoints
/// leave less time than the limits need (half of the shorter leg on either side), the change takes
/// all of that time and exceeds the limits. A rover whose first waypoint has time 0 is already
/// moving at time 0. After the last waypoint the rover is at rest.
class Route {
 public:
  static constexpr double kMaxYawRate_radps = std::numbers::pi / 3;

  /// \param ego must have waypoints.
  /// \throws input::Error at a waypoint that needs more than any rover's speed or acceleration.
  explicit Route(const scenario::Ego& ego);

  struct Motion {
    Eigen::Vector2d velocity_W_mps;
    double yaw_rate_radps;  ///< counter-clockwise
  };
  Motion at(double t_s) const;

 private:
  /// A change of velocity at constant acceleration.
  struct Change {
    double from_s, to_s;
    Eigen::Vector2d before_mps, after_mps;
  };
  /// A turn whose yaw rate is a parabola in time, 0 at both ends.
  struct Turn {
    double from_s, to_s, by_rad;
  };

  std::vector<Change> changes_;  ///< in order of time, one per waypoint
  std::vector<Turn> turns_;      ///< in order of time, one per bend
};

}  // namespace lcs::sim
