/// \file
/// `lcs world`: draws a scenario and its scene at random from a seed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/worlds/worlds.h"
#include "tools/app/world.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

using WorldOptions = Quietable<app::WorldRequest>;

constexpr const char* kWorldHelp = R"(Examples:
  lcs world room --seed 7 --out my/room          my/room/room_7.yaml and its scene
  lcs run my/room/room_7.yaml                    as any other scenario
  lcs world street --pictures ~/photos           surfaces from a folder of pictures
  lcs suite --worlds test --count 60             many of them at once

The same seed gives the same bytes. Seeds 1 to 999999 are of the split `train`, the next million of
`validate`, and the million after of `test`, by which nothing is chosen (scenes/worlds/README.md).

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

Command world_command() {
  return command_of("Draw a scenario and its scene from a seed, and write them", kWorldHelp,
                    &world);
}

}  // namespace lcs::tools
