/// \file
/// Checks that the filter works with given parameters; shared by tests and fuzzers.
#pragma once

#include <optional>
#include <string>

#include "tests/filter/invariants.h"
#include "tests/filter/world.h"

namespace lcs::testing {

/// A camera that drives over known ground, past points at several depths, some of which move.
struct SmallDrive {
  SmallDrive() {
    world.camera = {90, {79.5, 59.5}, 160, 120};
    Random random(1);
    for (int i = 0; i < 60; ++i) {
      world.add({random.uniform(2, 157), random.uniform(2, 117)}, random.uniform(1.5, 8));
    }
    for (int i = 0; i < 12; ++i) {
      world.add({random.uniform(90, 120), random.uniform(50, 80)}, 2.5, {-0.6, 0, 0});
    }
    motion.ground = Ground{.up_C = {0, -1, 0}, .height_m = 0.8};
  }

  World world;
  EgoMotion motion = steady_motion({0.05, 0.02, 0.5}, {0.02, -0.05, 0.03}, 0.1);
};

/// Eight frames of the small drive. \return the first violation, if any.
inline std::optional<std::string> violation_on_a_small_drive(const AnyParameters& parameters) {
  auto [world, motion] = SmallDrive();
  AnyFilter filter(world.camera, parameters);
  for (int k = 0; k < 8; ++k) {
    const auto corners = world.corners();
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    if (auto what = violation(result, corners.size(), world.camera, parameters)) return what;
    world.advance(motion);
  }
  return std::nullopt;
}

}  // namespace lcs::testing
