/// \file
/// The ego's commanded velocity, and the two drive types that execute it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/scene/model.h"

namespace lcs::sim {

/// Velocity of the rover's frame B, in B.
struct PlanarVelocity {
  Eigen::Vector2d linear_mps = Eigen::Vector2d::Zero();
  double yaw_rate_radps = 0;  ///< ccw
};

/// The commanded velocity at a time: the velocity of the last phase that has begun. The phase's
/// acceleration changes its speed, but never below 0.
PlanarVelocity commanded_velocity(const std::vector<scenario::EgoPhase>& phases, std::int64_t t_ns);

/// The command with limited accelerations: at a phase's jump in velocity, the change takes as long
/// as the limits need. Integration of IMU readings would miss a jump between two of them.
class SmoothCommand {
 public:
  static constexpr double kMaxAcceleration_mps2 = 5;
  static constexpr double kMaxYawAcceleration_radps2 = 10;

  /// Starts at the velocity commanded at time 0.
  explicit SmoothCommand(std::vector<scenario::EgoPhase> phases);

  /// \param t_ns must not decrease between calls.
  PlanarVelocity at(std::int64_t t_ns);

 private:
  std::vector<scenario::EgoPhase> phases_;
  double max_acceleration_mps2_;  ///< raised where a phase requests more
  PlanarVelocity now_;
  std::int64_t t_ns_ = 0;
};

/// Drives the body `ego/base` through the actuators of its fragment, or along its path.
class Rover {
 public:
  virtual ~Rover() = default;

  /// Sets the state at t = 0: at the start pose, settled on the ground, moving as commanded.
  /// \throws input::Error if no ground supports the rover
  virtual void start(Model& model) = 0;
  /// Sets the controls for the next step. \return the velocity that they ask for.
  virtual PlanarVelocity command(Model& model, std::int64_t t_ns) = 0;
  /// Velocity of B by the wheels, without noise.
  virtual PlanarVelocity odometry(const Model& model) const = 0;
  /// Sets accelerations that no force causes, after a forward pass.
  virtual void accelerate(Model&) {}
};

/// Carried if the ego has a path, holonomic if the rover has an actuator `x`, else wheeled.
/// \throws input::Error for a command that the drive cannot execute (sideways on wheels).
std::unique_ptr<Rover> make_rover(const scenario::Scenario& scenario, const Model& model);

}  // namespace lcs::sim
