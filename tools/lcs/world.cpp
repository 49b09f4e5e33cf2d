#include "tools/lcs/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <vector>

#include "tools/files/output.h"
#include "tools/files/output_file.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/terminal.h"
#include "tools/sequence/png.h"
#include "tools/worlds/sheet.h"
#include "tools/worlds/textures.h"
#include "tools/worlds/worlds.h"

namespace lcs::tools {
namespace {

constexpr const char* kHelp = R"(Examples:
  lcs world room --seed 7 --out my/room          my/room/room_7.yaml, and what it is made of
  lcs run my/room/room_7.yaml                    as any other scenario
  lcs world street --pictures ~/photos           with surfaces out of a folder of pictures
  lcs suite --worlds test --count 60             many of them at once

The same seed gives the same bytes. Seeds 1 to 999999 are of the split `train`, those of the next million
`validate`, and of the one after that `test`, by which nothing is chosen (tools/worlds/README.md).

Files written to the folder, all or none:
  FAMILY_SEED.yaml   the scenario, with what it has in its first lines
  scene.xml          the scene in MJCF, which MuJoCo's own viewer opens too
  textures/, meshes/ PNG and OBJ files
  plan.png           the world from above: what stands, the rover's way (blue), the movers' (magenta)
  sheet.png          with --sheet: first, middle and last picture with the truth's boxes, and the plan

Exit codes:
  0  fine
  2  error, or the folder holds anything else than a world that lcs wrote; nothing was written
  130  interrupted (Ctrl-C): likewise
)";

}  // namespace

CLI::App& add_world_command(CLI::App& app, WorldOptions& options) {
  CLI::App& command =
      *app.add_subcommand("world", "Draw a scenario and its scene from a seed, and write them");
  command
      .add_option("FAMILY", options.family,
                  fmt::format("One of {}", fmt::join(worlds::families(), ", ")))
      ->type_name("")
      ->required();
  add_seed_option(command, options.seed, "What it is drawn from; 1 if not given");
  add_out_option(command, options.out, "out/worlds/FAMILY_SEED");
  command
      .add_option("--pictures", options.pictures,
                  "Folder of pictures (.png, .jpg, .jpeg, .bmp) to take some of the surfaces from")
      ->type_name("DIR");
  command.add_flag("--sheet", options.sheet,
                   "Write sheet.png too: first, middle and last picture, and the plan from above");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return command;
}

ExitCode world(const WorldOptions& options) {
  std::vector<std::string> pictures;
  if (!options.pictures.empty()) pictures = worlds::pictures_in(options.pictures);
  const worlds::World drawn = worlds::draw_world({options.family, options.seed}, pictures);
  const std::filesystem::path target =
      options.out.empty() ? std::filesystem::path("out") / "worlds" / worlds::name_of(drawn)
                          : std::filesystem::path(options.out);
  bench::Output folder(target, worlds::world_files());
  worlds::write_world(drawn, folder.staging());
  if (options.sheet) {
    const auto scenario = folder.staging() / (worlds::name_of(drawn) + ".yaml");
    const cv::Mat3b sheet =
        worlds::contact_sheet(worlds::simulated_shots(scenario), worlds::plan(drawn), 2);
    bench::write_file(folder.staging() / worlds::kSheetFile,
                      sequence::encode_png(sheet, sequence::PngFilter::sub));
  }
  check_interrupted();
  folder.commit();
  if (!options.quiet) {
    print_out("{}: {} objects, {} movers, drawn again {} times\n  has      {}\n  files    {}\n",
              worlds::name_of(drawn), drawn.bodies.size(), drawn.scenario.actors.size(),
              drawn.attempt, fmt::join(drawn.features, ", "), folder.target().string());
  }
  return kFine;
}

}  // namespace lcs::tools
