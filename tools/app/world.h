/// \file
/// Draws a scenario and its scene at random from a seed, into a folder: the scenario, the scene, a
/// plan, textures and meshes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "scenes/worlds/worlds.h"
#include "tools/app/caller.h"
#include "tools/app/option.h"

namespace lcs::app {

struct WorldRequest {
  std::string family;
  std::uint64_t seed = 1;
  std::string out;            ///< folder; "": out/worlds/FAMILY_SEED
  std::string pictures = {};  ///< folder of pictures for textures; "": none
  bool sheet = false;
};

Options options_of(WorldRequest& request);

/// A world that is written, and its folder.
struct WorldMade {
  worlds::DrawnWorld world;
  std::filesystem::path folder;
};

/// \throws files::OutputError, std::exception; then no world is written.
WorldMade world(const WorldRequest& request, Caller& caller);

/// The plan view in a world's folder.
inline constexpr const char* kPlanFile = "plan.png";

/// Writes NAME.yaml, scene.xml, plan.png, textures/ and meshes/ into a folder.
/// \throws files::OutputError
void write_world(const worlds::DrawnWorld& world, const std::filesystem::path& folder);

/// Path of a world's stored scenario file in a folder of worlds; the name has a digest of the
/// sources that draw it, its family and its seed.
std::filesystem::path kept_world(const std::filesystem::path& folder, const worlds::Choice& choice);

}  // namespace lcs::app
