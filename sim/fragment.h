/// \file
/// Rovers and actors as MJCF: their fragments, ready to be put into a scene.
///
/// A fragment means in a scene what it means alone: its folders, angles and defaults are its own
/// (`sim/mjcf.h`). It is checked as it is loaded (`sim/fragment_contract.h`).
#pragma once

#include <string>

#include "scenarios/scenario.h"
#include "sim/xml.h"

namespace lcs::sim {

inline constexpr const char* kEgoPrefix = "ego/";

/// Texture of an actor that shows a picture from a file, within its fragment.
inline constexpr const char* kPictureTexture = "picture";

bool has_picture(const scenario::Actor& actor);

/// The fragment of an actor, scaled to the size asked for from the one that it states (boxes,
/// ellipsoids and meshes by any three factors; what is round about an axis stays round), painted,
/// without contacts, and with the actor's name before every name in it.
/// \param scene that it is for. \throws scenario::Error
xml::Document actor_fragment(const scenario::Actor& actor, const xml::Element& scene);

/// The rover's, with `kEgoPrefix` before every name; without contacts unless it is on wheels.
/// \param scene that it is for. \throws scenario::Error
xml::Document rover_fragment(const scenario::Ego& ego, const xml::Element& scene);

}  // namespace lcs::sim
