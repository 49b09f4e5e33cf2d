/// \file
/// Draws a scenario and its scene at random from a seed.
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

}  // namespace lcs::app
