/// \file
/// The folder of a drawn world: its scenario, scene, plan, textures and meshes.
#pragma once

#include <filesystem>

#include "scenes/worlds/worlds.h"
#include "tools/files/output.h"

namespace lcs::app {

/// The plan view, and an optional contact sheet (tools/preview/sheet.h).
inline constexpr const char* kPlanFile = "plan.png";
inline constexpr const char* kSheetFile = "sheet.png";

/// Files that a world's folder may hold, for `files::Output`.
files::ResultNames world_files();

/// Writes NAME.yaml, scene.xml, plan.png, textures/ and meshes/ into a folder.
/// \throws files::OutputError
void write_world(const worlds::DrawnWorld& world, const std::filesystem::path& folder);

/// Path of a world's stored scenario file in a folder of worlds; the name has a digest of the
/// sources that draw it, its family and its seed.
std::filesystem::path kept_world(const std::filesystem::path& folder, const worlds::Choice& choice);

}  // namespace lcs::app
