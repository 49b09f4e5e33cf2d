/// \file
/// Random worlds: each is determined by a family and a seed, and written as an ordinary scenario.
/// Equal inputs give equal bytes. README.md lists the random properties.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/worlds/world.h"

namespace lcs::worlds {

/// "room", "corridor" and so on, in a fixed order.
const std::vector<std::string>& families();

/// Purpose and seeds of a split. `test` is reserved for reported figures: no choice may depend on
/// it.
struct Split {
  std::string_view name;
  std::uint64_t first_seed, last_seed;
  std::string_view purpose;
};
const std::vector<Split>& splits();
/// \throws std::invalid_argument for an unknown name; lists the known ones.
const Split& split(std::string_view name);

/// One world of a suite.
struct Choice {
  std::string family;
  std::uint64_t seed = 0;
};
/// The first `count` worlds of a split, distributed evenly over the families, or of one family.
/// \throws std::invalid_argument for an unknown split or family.
std::vector<Choice> choose(std::string_view split, int count, const std::string& family = "");

/// A world in a folder of worlds, drawn or to be drawn.
struct Kept {
  Choice choice;
  std::filesystem::path file;  ///< its scenario; the stem is its name, as "room_7"
};

/// Whether the world has no movers: one in four, of plain ones one in three.
bool is_static(const Choice& choice);

/// \param pictures files used for some of the surfaces; may be empty.
/// \throws std::invalid_argument for an unknown family, std::runtime_error for an unreadable
/// picture.
DrawnWorld draw_world(const Choice& choice, const std::vector<std::string>& pictures = {});

/// For example "room_7".
std::string name_of(const DrawnWorld& world);

/// The world as MJCF and as a scenario, which name each other's files as `lcs world` writes them.
std::string scene_text(const DrawnWorld& world);
std::string scenario_text(const DrawnWorld& world);

/// Parses a name such as "room_7", for runs and sequences older than the record of their origin;
/// absent for any other name.
std::optional<scenario::Origin> origin_named(std::string_view name);

}  // namespace lcs::worlds
