/// \file
/// Rovers and actors as MJCF fragments, ready to be merged into a scene.
///
/// A fragment keeps its own folders, unit of angles and defaults (`sim/scene/mjcf.h`), so that a
/// scene cannot change its meaning. Loading checks it (`sim/scene/fragment_contract.h`).
#pragma once

#include <Eigen/Core>
#include <string>

#include "scenarios/scenario.h"
#include "sim/scene/xml.h"

namespace lcs::sim {

inline constexpr const char* kEgoPrefix = "ego/";

/// Name, within an actor's fragment, of the texture that a picture file fills.
inline constexpr const char* kPictureTexture = "picture";

bool has_picture(const scenario::Actor& actor);

/// [length, width, height] of an actor as its file states it, m. \param prefix of the names.
Eigen::Vector3d natural_size(xml::Element& root, const std::string& prefix);

/// The fragment of an actor: scaled from its file's size to the requested size, painted, without
/// contacts, with the actor's name as prefix of every name. Boxes, ellipsoids and meshes scale by
/// any three factors; cylinders and capsules stay round.
/// \param scene the scene that it will be merged into. \throws input::Error
xml::Document actor_fragment(const scenario::Actor& actor, const xml::Element& scene);

/// The fragment of the rover, with `kEgoPrefix` before every name. Only a wheeled rover keeps its
/// contacts.
/// \param scene the scene that it will be merged into. \throws input::Error
xml::Document rover_fragment(const scenario::Ego& ego, const xml::Element& scene);

}  // namespace lcs::sim
