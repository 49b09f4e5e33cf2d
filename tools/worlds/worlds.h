/// \file
/// Worlds without end: each drawn from a family and a seed, and written as an ordinary scenario.
/// The same family and seed give the same bytes. README.md says what is drawn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/files/output.h"
#include "tools/worlds/world.h"

namespace lcs::worlds {

/// "room", "corridor" and so on, in their order.
const std::vector<std::string>& families();

/// What must occur among worlds; a world lists those that it has.
const std::vector<std::string>& all_features();

/// What a split is for, and which seeds are its own. `test` is for stating figures: nothing is
/// chosen by it.
struct Split {
  std::string_view name;
  std::uint64_t first_seed, last_seed;
  std::string_view purpose;
};
const std::vector<Split>& splits();
/// \throws std::invalid_argument for an unknown name, naming the known ones.
const Split& split(std::string_view name);

/// One world of a suite.
struct Choice {
  std::string family;
  std::uint64_t seed = 0;
};
/// The first `count` worlds of a split, spread over the families evenly, or of one family.
/// \throws std::invalid_argument for an unknown split or family.
std::vector<Choice> choose(std::string_view split, int count, const std::string& family = "");

/// Whether nothing moves in it: one world in four.
bool is_static(const Choice& choice);

/// \param pictures files to take a part of the surfaces from; may be empty.
/// \throws std::invalid_argument for an unknown family, std::runtime_error for a picture that
///   cannot be read.
World draw_world(const Choice& choice, const std::vector<std::string>& pictures = {});

/// "room_7".
std::string name_of(const World& world);

/// The plan from above, and a contact sheet where one was asked for (sheet.h).
inline constexpr const char* kPlanFile = "plan.png";
inline constexpr const char* kSheetFile = "sheet.png";

/// Files that a world's folder may hold, as `bench::Output` takes them.
bench::ResultNames world_files();

/// Writes NAME.yaml, scene.xml, plan.png, textures/ and meshes/ into a folder.
/// \throws bench::OutputError
void write_world(const World& world, const std::filesystem::path& folder);

/// The world that a name as "room_7" means, for runs and sequences that are older than the
/// statement of their origin; none for any other name.
std::optional<scenario::Origin> origin_named(std::string_view name);

/// Where the scenario file of a world is kept, in a folder of worlds: named by what it is made of,
/// this program's generator, family and seed.
std::filesystem::path kept_world(const std::filesystem::path& folder, const Choice& choice);

}  // namespace lcs::worlds
