/// \file
/// `lcs preview`: shows a scenario's plan and its problems without running it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/load.h"
#include "sim/survey.h"
#include "tools/files/output.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/terminal.h"
#include "tools/preview/preview.h"

namespace lcs::tools {
namespace {

struct PreviewOptions {
  std::string scenario;  ///< scenario file
  std::string out;       ///< HTML file; "": out/preview/SCENARIO.html
  std::string mjcf;      ///< file for the world's MJCF; "": none
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;  ///< "key=value"
  bool force = false;
  bool quiet = false;
};

void print_preview(const scenario::Scenario& scenario, const preview::Preview& p,
                   const fs::path& page) {
  std::string text =
      fmt::format("{}: {} frames at {:g} Hz, {:.1f} s\n", scenario.name, scenario.frames,
                  scenario.camera.rate_hz, scenario.frames / scenario.camera.rate_hz);
  const auto [least, most] =
      std::ranges::minmax(p.corners_px, {}, [](const auto& corners) { return corners.size(); });
  text += fmt::format("  corners  {} to {} a frame\n", least.size(), most.size());
  for (const preview::PreviewMover& mover : p.movers) {
    text += fmt::format(
        "  actor    {}: {}, nearest {:.2f} m at {:.1f} s, in {} of {} pictures\n", mover.name,
        mover.moves
            ? fmt::format("moves from {:.1f} to {:.1f} s", mover.moves->from_s, mover.moves->to_s)
            : "never moves",
        mover.nearest_m, mover.nearest_s, mover.looks, p.looks.size());
  }
  write_out(fmt::format("{}  page     {}\n", text, page.string()));
}

ExitCode preview(const PreviewOptions& options) {
  const scenario::Scenario scenario =
      scenario::load(scenario_file(options.scenario), {.sets = options.sets, .seed = options.seed});
  const fs::path usual = fs::path("out") / "preview" / (scenario.name + ".html");
  files::Output page(app::place_of(options.out, usual), files::overwrite(options.force));
  std::vector<files::Output*> outputs{&page};
  std::optional<files::Output> world;
  if (!options.mjcf.empty()) {
    outputs.push_back(&world.emplace(options.mjcf, files::overwrite(options.force)));
  }
  const preview::Preview p = [&] {
    const auto progress =
        Terminal(options.quiet).progress(scenario.name, scenario.frames, "frames");
    return preview::preview(scenario, [&](int done) {
      check_interrupted();
      progress->show(done);
    });
  }();
  if (world) {
    const auto format = fs::path(options.mjcf).extension() == ".mjb" ? sim::WorldFormat::mjb
                                                                     : sim::WorldFormat::mjcf;
    files::write_file(world->staging(), sim::world_file(scenario, format));
  }
  preview::write_preview(page.staging(), scenario, p);
  check_interrupted();
  files::commit_all(outputs);
  if (!options.quiet) print_preview(scenario, p, page.target());
  for (const std::string& line : p.wrong) tell(line);
  return p.wrong.empty() ? kFine : kCriterionFailed;
}

app::Options options_of(PreviewOptions& options) {
  app::Options all("preview");
  all.add_scenario(options.scenario);
  all.add("--out", "FILE", &options.out, {.is_output = true});
  all.add_force(options.force);
  all.add("--mjcf", "FILE", &options.mjcf, {.is_output = true});
  all.add_seed(options.seed);
  all.add_set(options.sets);
  all.add("--quiet", "", &options.quiet);
  return all;
}

}  // namespace

Command preview_command() {
  return command_of("Check a scenario before a run: its plan, three pictures, its problems",
                    kPreviewHelp, &preview);
}

}  // namespace lcs::tools
