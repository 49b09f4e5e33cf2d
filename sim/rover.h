/// \file
/// The ego: what the scenario commands, and the two drives that carry it out.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/model.h"

namespace lcs::sim {

/// Velocity of the rover's frame B, in B.
struct PlanarVelocity {
  Eigen::Vector2d linear_mps = Eigen::Vector2d::Zero();
  double yaw_rate_radps = 0;  ///< ccw
};

/// The velocity that the phases command at a time: that of the last one that has begun, with its
/// speed changed by its acceleration and never below 0.
PlanarVelocity commanded_velocity(const std::vector<scenario::EgoPhase>& phases, std::int64_t t_ns);

/// The command with limited accelerations: where a phase begins at another velocity, the change
/// takes as long as the limits ask for. Integrating the IMU's readings would miss a jump between
/// two of them.
class SmoothCommand {
 public:
  static constexpr double kMaxAcceleration_mps2 = 5;
  static constexpr double kMaxYawAcceleration_radps2 = 10;

  /// Starts at the velocity commanded at 0.
  explicit SmoothCommand(std::vector<scenario::EgoPhase> phases);

  /// \param t_ns not before that of the last call.
  PlanarVelocity at(std::int64_t t_ns);

 private:
  std::vector<scenario::EgoPhase> phases_;
  double max_acceleration_mps2_;  ///< raised to what a phase asks for
  PlanarVelocity now_;
  std::int64_t t_ns_ = 0;
};

/// Drives the body `ego/base` through actuators of its fragment.
class Rover {
 public:
  virtual ~Rover() = default;

  /// Puts the model into the state at t = 0: at its start, settled on the ground, moving as
  /// commanded. \throws scenario::Error where nothing holds it
  virtual void start(Model& model) = 0;
  /// Sets the controls for the next step.
  virtual void command(Model& model, std::int64_t t_ns) = 0;
  /// Velocity of B as the wheels tell it, without noise.
  virtual PlanarVelocity odometry(const Model& model) const = 0;
};

/// Wheeled where the rover has an actuator `left`, else holonomic.
/// \throws scenario::Error for a command that the drive cannot carry out (a wheeled rover
/// sideways).
std::unique_ptr<Rover> make_rover(const scenario::Scenario& scenario, const Model& model);

}  // namespace lcs::sim
