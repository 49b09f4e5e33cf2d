#include "tools/app/world.h"

#include "tools/files/output.h"
#include "tools/files/output_file.h"
#include "tools/sequence/png.h"
#include "tools/worlds/sheet.h"
#include "tools/worlds/textures.h"

namespace lcs::app {

WorldMade world(const WorldRequest& request, Caller& caller) {
  std::vector<std::string> pictures;
  if (!request.pictures.empty()) pictures = worlds::pictures_in(request.pictures);
  worlds::World drawn = worlds::draw_world({request.family, request.seed}, pictures);
  const std::filesystem::path target =
      request.out.empty() ? std::filesystem::path("out") / "worlds" / worlds::name_of(drawn)
                          : std::filesystem::path(request.out);
  bench::Output folder(target, worlds::world_files());
  worlds::write_world(drawn, folder.staging());
  if (request.sheet) {
    const auto scenario = folder.staging() / (worlds::name_of(drawn) + ".yaml");
    const cv::Mat3b sheet =
        worlds::contact_sheet(worlds::simulated_shots(scenario), worlds::plan(drawn), 2);
    bench::write_file(folder.staging() / worlds::kSheetFile,
                      sequence::encode_png(sheet, sequence::PngFilter::sub));
  }
  caller.check();
  folder.commit();
  return {std::move(drawn), folder.target()};
}

}  // namespace lcs::app
