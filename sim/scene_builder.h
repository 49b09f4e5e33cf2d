/// \file
/// From a scenario to one MJCF document: the scene, the rover's fragment and those of its actors.
///
/// A scene is plain MJCF. A named body right below its worldbody is an *object*, what a square
/// should find; geoms right in the worldbody are the setting. A fragment is MJCF too, with one body
/// called `base` (x forward, z up, origin on the ground below its middle); its names get a prefix,
/// so that scene, rover and actors cannot clash.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/fragment.h"
#include "sim/xml.h"

namespace lcs::sim {

inline constexpr const char* kEgoBody = "ego/base";
inline constexpr const char* kCamera = "ego/camera";

/// A texture to fill after loading, with a picture from a file.
struct PictureTexture {
  std::string texture;
  std::filesystem::path file;
  scenario::Source source;
};

struct ComposedScene {
  xml::Printed mjcf;
  std::vector<std::string> actor_bodies;  ///< of each actor of the scenario, in its order
  std::vector<PictureTexture> pictures;
};

/// \throws scenario::Error for files that are missing or no MJCF, actors on bodies that the scene
///   lacks or that another actor has, names used twice, sizes that a shape cannot have, and for
///   what goes beyond the limits (`sim/limits.h`).
ComposedScene compose(const scenario::Scenario& scenario);

}  // namespace lcs::sim
