/// \file
/// The sections `image` and `ground`: what the camera makes of the scene, and what wheels roll
/// over.
#pragma once

#include "scenarios/reader.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// \throws Error
Image read_image(Reader reader);
/// \throws Error
Ground read_ground(Reader reader);

}  // namespace lcs::scenario
