/// \file
/// `lcs world`: draws a scenario and its scene at random from a seed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "tools/app/world.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/options.h"
#include "tools/lcs/terminal.h"
#include "tools/worlds/worlds.h"

namespace lcs::tools {
namespace {

struct WorldOptions {
  app::WorldRequest request;
  bool quiet = false;
};

constexpr const char* kHelp = R"(Examples:
  lcs world room --seed 7 --out my/room          my/room/room_7.yaml and its scene
  lcs run my/room/room_7.yaml                    as any other scenario
  lcs world street --pictures ~/photos           surfaces from a folder of pictures
  lcs suite --worlds test --count 60             many of them at once

The same seed gives the same bytes. Seeds 1 to 999999 are of the split `train`, those of the next million
`validate`, and of the one after that `test`, by which nothing is chosen (tools/worlds/README.md).

Files written to the folder, all or none:
  FAMILY_SEED.yaml   the scenario, with a summary in its first lines
  scene.xml          the scene in MJCF, which MuJoCo's own viewer opens too
  textures/, meshes/ PNG and OBJ files
  plan.png           the world from above: fixed objects, the way of the rover (blue), of the movers (magenta)
  sheet.png          with --sheet: first, middle and last picture with the truth's boxes, and the plan

Exit codes:
  0  fine
  2  error, or the folder holds anything else than a world that lcs wrote; nothing was written
  130  interrupted (Ctrl-C): likewise
)";

ExitCode world(const WorldOptions& options) {
  Terminal terminal(options.quiet);
  const auto [drawn, folder] = app::world(options.request, terminal);
  if (!options.quiet) {
    print_out("{}: {} objects, {} movers, drawn again {} times\n  has      {}\n  files    {}\n",
              worlds::name_of(drawn), drawn.bodies.size(), drawn.scenario.actors.size(),
              drawn.attempt, fmt::join(drawn.features, ", "), folder.string());
  }
  return kFine;
}

}  // namespace

Command add_world_command(CLI::App& app) {
  const auto owned = std::make_shared<WorldOptions>();
  WorldOptions& options = *owned;
  CLI::App& command =
      *app.add_subcommand("world", "Draw a scenario and its scene from a seed, and write them");
  command
      .add_option("FAMILY", options.request.family,
                  fmt::format("One of {}", fmt::join(worlds::families(), ", ")))
      ->type_name("")
      ->required();
  add_seed_option(command, options.request.seed, "Seed of the world; 1 if not given");
  add_out_option(command, options.request.out, "out/worlds/FAMILY_SEED");
  command
      .add_option("--pictures", options.request.pictures,
                  "Folder of pictures (.png, .jpg, .jpeg, .bmp) to take some of the surfaces from")
      ->type_name("DIR");
  command.add_flag("--sheet", options.request.sheet,
                   "Write sheet.png too: first, middle and last picture, and the plan from above");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return {command, [owned] { return world(*owned); }};
}

}  // namespace lcs::tools
