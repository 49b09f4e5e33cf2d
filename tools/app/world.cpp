#include "tools/app/world.h"

#include <fmt/format.h>

#include "scenes/worlds/meshes.h"
#include "scenes/worlds/textures.h"
#include "tools/files/output.h"
#include "tools/files/output_file.h"
#include "tools/preview/sheet.h"
#include "tools/sequence/png.h"

namespace lcs::app {

constexpr const char* kSheetFile = "sheet.png";  // optional: contact sheet (tools/preview/sheet.h)

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

WorldMade world(const WorldRequest& request, Caller& caller) {
  std::vector<std::string> pictures;
  if (!request.pictures.empty()) pictures = worlds::pictures_in(request.pictures);
  worlds::DrawnWorld drawn = worlds::draw_world({request.family, request.seed}, pictures);
  files::Output folder(
      place_of(request.out, std::filesystem::path("out") / "worlds" / worlds::name_of(drawn)),
      {"scene.xml", "*.yaml", "textures/*.png", "meshes/*.obj", kPlanFile, kSheetFile});
  write_world(drawn, folder.staging());
  if (request.sheet) {
    const auto scenario = folder.staging() / (worlds::name_of(drawn) + ".yaml");
    const cv::Mat3b sheet =
        preview::contact_sheet(preview::simulated_shots(scenario), preview::plan(drawn), 2);
    files::write_file(folder.staging() / kSheetFile,
                      sequence::encode_png(sheet, sequence::PngFilter::sub));
  }
  caller.check();
  folder.commit();
  return {std::move(drawn), folder.target()};
}

}  // namespace lcs::app
