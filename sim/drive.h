/// \file
/// The motion and sensor readings of a scenario without images, for uses that need the rover, its
/// IMU and its true poses. Needs no GL.
#pragma once

#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::sim {

class World;

struct Drive {
  Calibration calibration;
  /// Bitwise equal to `Simulation`'s frames, but without images, depths, objects and `imu_truth`.
  std::vector<Observation> frames;
};

/// \throws input::Error, PhysicsError
Drive drive(const scenario::Scenario& scenario);

/// The calibration of a world at t = 0.
Calibration calibrate(const World& world, const scenario::Camera& camera);

}  // namespace lcs::sim
