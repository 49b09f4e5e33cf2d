/// \file
/// An actor's shape as MJCF: its fragment, scaled to the size asked for and painted.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "scenarios/scenario.h"
#include "sim/xml.h"

namespace lcs::sim {

/// Scales the geoms of a fragment's body from the natural size that it states (the numeric `size`:
/// length, width, height in m). Boxes and ellipsoids take any three factors; what is round about an
/// axis stays round.
void scale_fragment(xml::Element& root, const Eigen::Vector3d& size_m);

/// Texture of an actor that shows a picture from a file, within its fragment.
inline constexpr const char* kPictureTexture = "picture";

bool has_picture(const scenario::Actor& actor);

/// The fragment of an actor, scaled, painted, and with the actor's name before every name in it.
/// \throws scenario::Error
xml::Document actor_fragment(const scenario::Actor& actor);

}  // namespace lcs::sim
