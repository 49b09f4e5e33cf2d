#include "tools/app/world_folder.h"

#include <fmt/format.h>

#include "scenes/worlds/meshes.h"
#include "tools/files/output_file.h"
#include "tools/preview/sheet.h"
#include "tools/sequence/png.h"

namespace lcs::app {

files::ResultNames world_files() {
  return {"scene.xml", "*.yaml", "textures/*.png", "meshes/*.obj", kPlanFile, kSheetFile};
}

void write_world(const worlds::DrawnWorld& world, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "textures");
  std::filesystem::create_directories(folder / "meshes");
  for (const worlds::Texture& texture : world.textures) {
    files::write_file(folder / "textures" / (texture.name + ".png"),
                      sequence::encode_png(texture.picture, sequence::PngFilter::up));
  }
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    files::write_file(folder / "meshes" / fmt::format("mesh_{}.obj", i),
                      worlds::obj_text(world.meshes[i]));
  }
  files::write_file(folder / kPlanFile,
                    sequence::encode_png(preview::plan(world), sequence::PngFilter::up));
  files::write_file(folder / "scene.xml", worlds::scene_text(world));
  files::write_file(folder / (worlds::name_of(world) + ".yaml"), worlds::scenario_text(world));
}

std::filesystem::path kept_world(const std::filesystem::path& folder,
                                 const worlds::Choice& choice) {
  const std::string name = fmt::format("{}_{}", choice.family, choice.seed);
  return folder / LCS_WORLDS_MADE_BY / name / (name + ".yaml");
}

}  // namespace lcs::app
