/// \file
/// Rovers and actors from files of their own, ready to be attached to a scene.
///
/// A fragment is MJCF with one body called `base` (x forward, z up, origin on the ground below its
/// middle). MuJoCo compiles it with its own unit of angles, folders and defaults, so that a scene
/// cannot change its meaning. Loading checks it (`sim/scene/fragment_contract.h`).
#pragma once

#include <Eigen/Core>

#include "scenarios/scenario.h"
#include "sim/scene/spec.h"

namespace lcs::sim {

/// Name, within an actor's fragment, of the texture that a picture file fills.
inline constexpr const char* kPictureTexture = "picture";

bool has_picture(const scenario::Actor& actor);

struct Fragment {
  Spec spec;
  mjsBody* base = nullptr;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< of an actor: [length, width, height]
  bool is_frozen = false;  ///< an actor had joints, which keep `Actor::pose`
};

/// The fragment of an actor: posed, scaled from its file's size to the requested size, painted, and
/// without contacts. Boxes, ellipsoids and meshes scale by any three factors along their own axes;
/// cylinders and capsules stay round. \throws input::Error
Fragment actor_fragment(const scenario::Actor& actor, SpecReader& reader);

/// The fragment of the rover. Only a wheeled rover keeps its contacts. \throws input::Error
Fragment rover_fragment(const scenario::Ego& ego, SpecReader& reader);

}  // namespace lcs::sim
