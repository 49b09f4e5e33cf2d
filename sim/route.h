/// \file
/// The motion of a rover that is given places and times instead of commands.
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::sim {

/// Straight and uniform from each waypoint to the next, with limited accelerations: round each
/// waypoint velocity and heading take some time to change, half of it before the waypoint and half
/// behind.
///
/// A change of velocity by dv takes |dv| / 5 m/s^2 (`SmoothCommand` has the limits), so that a bend
/// is rounded by |dv|^2 / 40 m/s^2: 12 mm for a right angle at 0.5 m/s. The rover looks where it
/// goes, but turns at no more than 60 deg/s, and so looks aside for a while in a sharp bend;
/// between two waypoints at one place it turns on the spot. Where the waypoints leave less time
/// than the limits ask for (half of the shorter leg on either side), the change takes all of that
/// time and exceeds the limits. If the first waypoint is at time 0, the rover is already moving at
/// 0; after the last one it stands.
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
  /// An even change from one velocity to another.
  struct Change {
    double from_s, to_s;
    Eigen::Vector2d before_mps, after_mps;
  };
  /// A turn by an angle, at a rate that grows from 0 and falls to 0 again.
  struct Turn {
    double from_s, to_s, by_rad;
  };

  std::vector<Change> changes_;  ///< in order of time, one for each waypoint
  std::vector<Turn> turns_;      ///< likewise, where the way bends
};

}  // namespace lcs::sim
