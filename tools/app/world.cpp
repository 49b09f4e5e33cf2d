#include "tools/app/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>
#include <thread>

#include "scenarios/load.h"
#include "scenes/worlds/textures.h"
#include "scenes/worlds/world.h"
#include "sim/pictures/picture_file.h"
#include "tools/files/output.h"
#include "tools/files/output_file.h"
#include "tools/files/written.h"
#include "tools/output/frame_pictures.h"
#include "tools/preview/sheet.h"
#include "tools/recording/recording_io.h"
#include "tools/report/report_page.h"
#include "tools/sequence/png.h"
#include "tools/suite/child_process.h"

namespace lcs::app {
namespace {

constexpr const char* kFolder = "out/worlds";

/// The plan view, and an optional contact sheet (tools/preview/sheet.h).
constexpr const char *kPlanFile = "plan.png", *kSheetFile = "sheet.png";

/// Path of a world's stored scenario file in a folder of worlds; the name has a digest of the
/// sources that draw it, its family and its seed.
fs::path kept_world(const fs::path& folder, const worlds::Choice& choice) {
  const std::string name = fmt::format("{}_{}", choice.family, choice.seed);
  return folder / LCS_WORLDS_MADE_BY / name / (name + ".yaml");
}

/// Pictures and truth of a run's sampled frames; absent if the run has no pictures.
std::optional<preview::Shots> recorded_shots(const fs::path& run, cv::Size image_px) {
  if (!fs::exists(run / output::kPicturesFile)) return std::nullopt;
  const output::FramePictures pictures(run / output::kPicturesFile, image_px);
  const auto shown = preview::frames_shown(static_cast<int>(pictures.size()));
  const auto objects = recording::read_object_truth(run, shown);
  preview::Shots shots;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    shots[i].frame = shown[i];
    shots[i].picture = pictures.at(static_cast<std::size_t>(shown[i]), shots[i].scale);
    shots[i].objects = objects[i];
  }
  return shots;
}

void write_sheet(const fs::path& folder, const suite::PlannedScenario& planned,
                 const suite::ScenarioResult& scenario, Caller& caller) {
  constexpr int kQuality = 85, kColumns = 4;
  // Always of the world's own seed, so that the parts of a suite have the pictures of the whole.
  const suite::RunResult& run = scenario.runs.front();
  if (run.folder.empty() || !planned.scenario || run.seed != planned.scenario->seed) return;
  const auto shots = recorded_shots(
      folder / run.folder, {planned.scenario->camera.width_px, planned.scenario->camera.height_px});
  if (!shots) return;
  const fs::path plan = scenario.file.parent_path() / kPlanFile;
  cv::Mat3b above;
  try {
    above = sim::read_picture(plan, {plan.string(), 0}, cv::IMREAD_COLOR);
  } catch (const input::Error& error) {  // keep the runs without this picture
    caller.warn({error.what()});
  }
  files::write_file(folder / report::sheet_path(scenario),
                    sim::encode_jpeg(preview::contact_sheet(*shots, above, kColumns), kQuality));
}

}  // namespace

void write_world(const worlds::DrawnWorld& world, const fs::path& folder) {
  fs::create_directories(folder / "textures");
  fs::create_directories(folder / "meshes");
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

WorldMade world(const WorldRequest& request, Caller& caller) {
  std::vector<std::string> pictures;
  if (!request.pictures.empty()) pictures = worlds::pictures_in(request.pictures);
  worlds::DrawnWorld drawn = worlds::draw_world({request.family, request.seed}, pictures);
  files::Output folder(
      place_of(request.out, fs::path("out") / "worlds" / worlds::name_of(drawn)),
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

std::vector<worlds::Kept> chosen_worlds(const WorldsChoice& choice, const std::string& filter) {
  const suite::Pattern wanted(filter, "--filter", "^room");
  std::vector<worlds::Choice> choices = worlds::choose(choice.split, choice.count, choice.family);
  std::stable_sort(choices.begin(), choices.end(),
                   [](const auto& a, const auto& b) { return a.family < b.family; });
  std::vector<worlds::Kept> chosen;
  for (const worlds::Choice& one : choices) {
    const fs::path file = kept_world(kFolder, one);
    if (wanted.is_in(file.stem().string())) chosen.push_back({one, file});
  }
  if (chosen.empty()) throw std::runtime_error("no world fits --filter; its names are as room_7");
  return chosen;
}

std::size_t jobs_at_once(int jobs) {
  return jobs > 0 ? static_cast<std::size_t>(jobs)
                  : std::max(1U, std::thread::hardware_concurrency());
}

std::vector<fs::path> draw_worlds(const std::vector<worlds::Kept>& chosen, std::size_t jobs,
                                  Caller& caller) {
  std::vector<fs::path> files;
  std::vector<std::vector<std::string>> commands;
  for (const auto& [choice, file] : chosen) {
    files.push_back(file);
    const fs::path world = file.parent_path();
    if (fs::exists(world) && !fs::is_empty(world)) {
      const std::string what = files::first_difference(world);
      if (what.empty()) continue;
      throw files::OutputError("{}: {}; remove that folder, so that the world is drawn anew",
                               world.string(), what);
    }
    fs::create_directories(world.parent_path());
    commands.push_back(arguments_of(
        WorldRequest{.family = choice.family, .seed = choice.seed, .out = world.string()}));
    commands.back().emplace_back("--quiet");
  }
  suite::run_all(
      commands, jobs,
      [](std::size_t, const suite::Exit& exit) {
        if (!exit.is_fine()) throw std::runtime_error(suite::complaint_of(exit));
      },
      [&](const std::vector<std::size_t>&) { caller.check(); });
  return files;
}

void add_origins(suite::SuiteResult& result) {
  for (suite::ScenarioResult& scenario : result.scenarios) {
    scenario.drawn.emplace();
    try {
      const scenario::Origin origin =
          scenario::load(scenario.file).origin.value_or(scenario::Origin{});
      scenario.drawn = {origin.family, origin.again, origin.features};
    } catch (const input::Error&) {  // the runs have reported it
    }
  }
}

void write_sheets(const fs::path& folder, const std::vector<suite::PlannedScenario>& plan,
                  const suite::SuiteResult& result, Caller& caller) {
  fs::create_directories(folder / report::kSheetsFolder);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    caller.check();
    write_sheet(folder, plan[i], result.scenarios[i], caller);
  }
}

}  // namespace lcs::app
