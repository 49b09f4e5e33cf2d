/// \file
/// Draws a scenario and its scene at random from a seed, into a folder: the scenario, the scene, a
/// plan, textures and meshes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/worlds/worlds.h"
#include "tools/app/caller.h"
#include "tools/app/option.h"
#include "tools/suite/plan.h"
#include "tools/suite/suite_result.h"

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

/// Writes NAME.yaml, scene.xml, plan.png, textures/ and meshes/ into a folder.
/// \throws files::OutputError
void write_world(const worlds::DrawnWorld& world, const std::filesystem::path& folder);

// ---- The worlds that a command runs. Missing worlds are drawn first.

/// Worlds of a split.
struct WorldsChoice {
  std::string split = {};  ///< train, validate or test; "": no worlds
  int count = 60;
  std::string family = {};  ///< "": all families
};

/// The chosen worlds, ordered by family, without drawing them.
/// \param filter regular expression that a part of the name matches; "": any.
/// \throws std::invalid_argument for an unknown split or family; std::runtime_error for an invalid
///   filter and if no world fits.
std::vector<worlds::Kept> chosen_worlds(const WorldsChoice& choice, const std::string& filter);

/// The number of jobs; for 0 the number of processors.
std::size_t jobs_at_once(int jobs);

/// Draws the worlds that are missing in out/worlds/, each in its own process, `jobs` at a time.
/// \return the scenario files of all of them.
/// \throws files::OutputError for a world that was edited, std::runtime_error.
std::vector<std::filesystem::path> draw_worlds(const std::vector<worlds::Kept>& chosen,
                                               std::size_t jobs, Caller& caller);

/// Adds to `result` how each world was drawn, from the worlds' scenario files.
void add_origins(suite::SuiteResult& result);

/// Writes worlds/ into the folder of a suite: a picture of each world, from its first run.
/// \param plan the plan that `result` came from, in the same order.
/// \throws files::OutputError; std::runtime_error if a run's files cannot be read.
void write_sheets(const std::filesystem::path& folder,
                  const std::vector<suite::PlannedScenario>& plan, const suite::SuiteResult& result,
                  Caller& caller);

}  // namespace lcs::app
