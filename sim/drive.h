/// \file
/// The motion and the sensor readings of a scenario without pictures, for uses that need the rover,
/// its IMU and its true poses, but no camera. Needs no GL.
#pragma once

#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::sim {

class World;

struct Drive {
  Calibration calibration;
  /// The same bits as `Simulation` gives, but without images, depths, objects and the truth of the
  /// readings.
  std::vector<Observation> frames;
};

/// \throws scenario::Error, PhysicsError
Drive drive(const scenario::Scenario& scenario);

/// The calibration of a world at t = 0.
Calibration calibrate(const World& world, const scenario::Camera& camera);

}  // namespace lcs::sim
