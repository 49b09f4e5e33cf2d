/// \file
/// Where an actor is: the mathematics of trajectories and start triggers, without physics.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "scenarios/scenario.h"

namespace lcs::sim {

/// On the ground plane of W. An actor heads along its x.
struct PlanarPose {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
};

/// Where a trajectory is `seconds` after its start trigger (before it: at its first point).
/// \param home the pose that the scene gives the body, for what the trajectory leaves open.
PlanarPose pose_on(const scenario::Trajectory& trajectory, const PlanarPose& home, double seconds);

/// Fires once: at the first call of `update` at which all of its conditions hold.
class Trigger {
 public:
  explicit Trigger(const scenario::StartTrigger& conditions) : conditions_(conditions) {}

  /// \param t_ns not before that of the last call.
  /// \return seconds since the trigger fired, negative while it has not.
  double update(std::int64_t t_ns, double ego_distance_m);

 private:
  scenario::StartTrigger conditions_;
  std::optional<double> start_s_;
};

}  // namespace lcs::sim
