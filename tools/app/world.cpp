#include "tools/app/world.h"
#include "tools/app/world_folder.h"

#include "scenes/worlds/textures.h"
#include "tools/files/output.h"
#include "tools/files/output_file.h"
#include "tools/preview/sheet.h"
#include "tools/sequence/png.h"

namespace lcs::app {

WorldMade world(const WorldRequest& request, Caller& caller) {
  std::vector<std::string> pictures;
  if (!request.pictures.empty()) pictures = worlds::pictures_in(request.pictures);
  worlds::DrawnWorld drawn = worlds::draw_world({request.family, request.seed}, pictures);
  files::Output folder(
      place_of(request.out, std::filesystem::path("out") / "worlds" / worlds::name_of(drawn)),
      world_files());
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
