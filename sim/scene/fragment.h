/// \file
/// Rovers and actors from files of their own, ready to be attached to a scene.
///
/// A fragment is MJCF with one body called `base` (x forward, z up, origin on the ground below its
/// middle). MuJoCo compiles it with its own unit of angles, folders and defaults, so that a scene
/// cannot change its meaning. Loading checks it (fragment_contract.cpp).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/scene/spec.h"

namespace lcs::sim {

/// Name, within an actor's fragment, of the texture that a picture file fills.
inline constexpr const char* kPictureTexture = "picture";

struct Fragment {
  Spec spec;
  mjsBody* base = nullptr;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< of an actor: [length, width, height]
  bool is_frozen = false;                            ///< it had joints, which keep a pose
  std::vector<std::string> loose_joints = {};        ///< of a rover: see `Warning::joints_loose`
};

/// The fragment of an actor: posed, scaled from its file's size to the requested size, painted, and
/// without contacts. Boxes and ellipsoids scale by any three factors along their own axes, meshes
/// along the actor's; cylinders and capsules stay round. \throws input::Error
Fragment actor_fragment(const scenario::Actor& actor, SpecReader& reader);

/// The fragment of the rover. Only a wheeled rover keeps its contacts. \throws input::Error
Fragment rover_fragment(const scenario::Ego& ego, SpecReader& reader);

/// Takes joints away from a model that compiles by itself: their bodies keep the poses of a
/// keyframe or, by `kPoseZero`, of MuJoCo's reference. What refers to the joints goes with them.
/// Bodies with a free joint that stays start there, except `base`. \param goes whether a joint
/// goes. \param who has the pose. \return whether there were such joints. \throws input::Error for
/// an unknown keyframe; MujocoError.
bool freeze(mjSpec& spec, const std::string& pose, const std::function<bool(mjsElement*)>& goes,
            const std::string& who, const input::Source& where, const mjsBody* base = nullptr);

/// \name Checks that a rover's or actor's file has all required elements; `scenes/README.md` lists
/// them. All throw input::Error at the file's line: the missing or wrong element, and the remedy.
///@{
/// \return the body `base`.
mjsBody& check_base(const mjSpec& spec, const SpecReader& reader,
                    const std::filesystem::path& file);
/// \return the size that the file states.
Eigen::Vector3d check_actor(const Fragment& actor, const SpecReader& reader);
/// \param base whose joints are at zero: the bodies in it are those that `Gait` moves.
void check_walker(const mjsBody& base, const SpecReader& reader);
void check_rover(const Fragment& rover, const SpecReader& reader);
///@}

/// Whether a rover's actuator of that name drives it.
bool is_driven(std::string_view actuator);

/// Whether a rover that passed `check_rover` is wheeled; otherwise it is holonomic.
bool is_wheeled(const mjSpec& spec);

}  // namespace lcs::sim
