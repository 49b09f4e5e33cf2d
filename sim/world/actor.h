/// \file
/// Actor kinematics: trajectories and start triggers, without physics.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::sim {

/// A pose on the ground plane of W. The actor's x axis points along its heading.
struct PlanarPose {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  double walked_m = 0;  ///< along the trajectory since its start
};

/// Pose on a trajectory, `seconds` after its start trigger. Before the trigger: the first point.
/// \param home the scene's pose of the body; fills in values that the trajectory omits.
PlanarPose pose_on(const scenario::Trajectory& trajectory, const PlanarPose& home, double seconds);

/// The value of a joint, rad or m, and its rate, 1/s, at `seconds` as in `pose_on`.
struct JointState {
  double value = 0, rate = 0;
};
JointState joint_at(const std::vector<scenario::JointPoint>& points, double seconds);

/// Fires once, at the first call of `update` at which all its conditions hold.
class Trigger {
 public:
  explicit Trigger(const scenario::StartTrigger& conditions) : conditions_(conditions) {}

  /// \param t_ns must not decrease between calls.
  /// \return seconds since the trigger fired; -1 before it fired.
  double update(std::int64_t t_ns, double ego_distance_m);

 private:
  scenario::StartTrigger conditions_;
  std::optional<double> start_s_;
};

}  // namespace lcs::sim
