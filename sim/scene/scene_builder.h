/// \file
/// Composes one MuJoCo model from a scenario: the scene and the fragments of rover and actors.
///
/// A scene is plain MJCF. A named body directly in its worldbody is an *object*, which a square
/// should find. Geoms directly in the worldbody are the static setting. A fragment is MJCF with one
/// body called `base` (x forward, z up, origin on the ground below its middle); its names get a
/// prefix, so that names of scene, rover and actors cannot clash.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/scene/spec.h"

namespace lcs::sim {

inline constexpr const char* kEgoPrefix = "ego/";
inline constexpr const char* kEgoBody = "ego/base";
inline constexpr const char* kCamera = "ego/camera";

/// A texture to fill from an image file after loading.
struct PictureTexture {
  std::string texture;
  std::filesystem::path file;
  input::Source source;
};

struct ComposedScene {
  SpecReader reader;
  Spec spec;
  std::vector<std::string> actor_bodies;  ///< body of each actor, in the scenario's order
  /// Size of each actor, [length, width, height] in m; absent for a body of the scene.
  std::vector<std::optional<Eigen::Vector3d>> actor_sizes_m;
  std::vector<std::string> frozen;  ///< what keeps a pose: "actor 'dog' keeps the pose 'home'"
  std::vector<std::string> loose_joints;  ///< of the rover: those with a motor, beside the drive
  std::vector<std::string> named;         ///< bodies without a name, with the one that they got
  std::vector<PictureTexture> pictures;

  /// Source of a named element; the scene's file without one.
  input::Source source(mjtObj type, std::string_view name) const {
    return reader.source(name.empty() ? nullptr : find(*spec, type, name));
  }
};

/// \throws input::Error for missing files, files that are not MJCF, actors on bodies that the
/// scene lacks or another actor moves, duplicate names, impossible sizes of a shape, and values
/// beyond the limits (`sim/scene/limits.h`).
ComposedScene compose(const scenario::Scenario& scenario);

}  // namespace lcs::sim
