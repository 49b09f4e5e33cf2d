/// \file
/// Rovers and actors as MJCF fragments, ready to be merged into a scene.
///
/// A fragment means the same in every scene as it does alone: it keeps its own folders, unit of
/// angles and defaults (`sim/mjcf.h`). Loading checks it (`sim/fragment_contract.h`).
#pragma once

#include <string>

#include "scenarios/scenario.h"
#include "sim/xml.h"

namespace lcs::sim {

inline constexpr const char* kEgoPrefix = "ego/";

/// The name, within its fragment, of the texture of an actor that shows a picture from a file.
inline constexpr const char* kPictureTexture = "picture";

bool has_picture(const scenario::Actor& actor);

/// The fragment of an actor: scaled from the size that its file states to the one asked for (boxes,
/// ellipsoids and meshes by any three factors; what is round about an axis stays round), painted,
/// without contacts, and with the actor's name before every name in it.
/// \param scene that it is for. \throws scenario::Error
xml::Document actor_fragment(const scenario::Actor& actor, const xml::Element& scene);

/// The fragment of the rover, with `kEgoPrefix` before every name; without contacts unless it is on
/// wheels.
/// \param scene that it is for. \throws scenario::Error
xml::Document rover_fragment(const scenario::Ego& ego, const xml::Element& scene);

}  // namespace lcs::sim
