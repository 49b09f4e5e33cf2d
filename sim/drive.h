/// \file
/// A scenario's motion and its sensors' readings without any picture: for what needs the rover, its
/// IMU and the truth of its poses, but no camera. Needs no GL.
#pragma once

#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::sim {

class World;

struct Drive {
  Calibration calibration;
  /// As `Simulation` gives them, bit by bit, but for images, depths, objects and the truth of each
  /// reading, which are empty.
  std::vector<Observation> frames;
};

/// \throws scenario::Error, PhysicsError
Drive drive(const scenario::Scenario& scenario);

/// Of a world at t = 0.
Calibration calibrate(const World& world, const scenario::Camera& camera);

}  // namespace lcs::sim
