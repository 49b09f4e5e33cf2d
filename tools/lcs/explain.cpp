/// \file
/// `lcs explain`: the numbers by which the filter called a corner of a run a rebel, or did not.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/bench/bench.h"
#include "tools/explain/explainer.h"
#include "tools/files/json_node.h"
#include "tools/files/output.h"
#include "tools/files/provenance.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/terminal.h"
#include "tools/output/frame_pictures.h"
#include "tools/sequence/png.h"

namespace lcs::tools {
namespace {

struct ExplainOptions {
  std::string run;                     ///< folder
  std::optional<std::uint64_t> frame;  ///< absent: all
  std::optional<double> x_px, y_px;    ///< near the corner
  std::optional<Id> track;             ///< in place of x and y
  bool json = false;
  std::string picture;  ///< PNG file; "": none
  bool force = false;
};

/// The parameters of a run's filter, by its run.json, in which earlier versions state none.
AnyParameters parameters_of(const std::string& run) {
  scenario::Scenario settings;
  const files::Json facts = files::read_how_made(run).facts;
  if (facts.contains("filter")) {
    files::JsonNode(facts, "")["filter"].each_entry([&](const std::string& key, const auto& value) {
      settings.filter.push_back({key, value.text(), {run, 0}});
    });
    settings.filter_preset = files::JsonNode(facts, "")["preset"].text();
  }
  return bench::filter_parameters(settings);
}

constexpr double kNear_px = 3;  // the radius of FAST's circle

/// The index of the corner nearest to a place. \throws std::runtime_error if none is near.
std::size_t corner_at(const Vec2& place_px, const recording::FrameRecord& frame) {
  const auto off_px = [&](const Eigen::Vector2f& x) {
    return (x.cast<double>() - place_px).norm();
  };
  const auto nearest = std::ranges::min_element(frame.corners_px, {}, off_px);
  if (nearest == frame.corners_px.end())
    throw std::runtime_error("the frame has no corner; give another");
  if (off_px(*nearest) > kNear_px) {
    throw std::runtime_error(fmt::format(
        "no corner lies within {} px of ({:g}, {:g}); the nearest is ({:g}, {:g}), {:.1f} px away",
        kNear_px, place_px.x(), place_px.y(), nearest->x(), nearest->y(), off_px(*nearest)));
  }
  return static_cast<std::size_t>(nearest - frame.corners_px.begin());
}

/// The corner that is asked for. \throws std::runtime_error if there is none.
std::size_t corner_of(const ExplainOptions& options, const explain::Explained& said) {
  if (options.x_px) return corner_at({*options.x_px, *options.y_px}, said.frame);
  const auto found = std::ranges::find(said.track_of, options.track.value());
  if (found != said.track_of.end()) return static_cast<std::size_t>(found - said.track_of.begin());
  throw std::runtime_error(
      fmt::format("no corner of the frame is on track {}; give X and Y", *options.track));
}

void write_picture(const ExplainOptions& options, const explain::Explained& said,
                   std::size_t corner) {
  const std::filesystem::path file = std::filesystem::path(options.run) / output::kPicturesFile;
  const cv::Size size(said.run.camera->width_px, said.run.camera->height_px);
  cv::Mat3b image(size, cv::Vec3b::all(0));
  const bool is_there = std::filesystem::exists(file);
  if (is_there) image = output::FramePictures(file, size).image(said.frame.index);
  files::Output picture(options.picture, files::overwrite(options.force));
  files::write_file(picture.staging(),
                    sequence::encode_png(picture_of(said, corner, image), sequence::PngFilter::up));
  picture.commit();
  if (!is_there) tell(options.run + " has no pictures, only marks are drawn: --events keeps some");
}

/// A line for each corner. \param with_history its sightings, too, which the frames before have.
void print_all(const explain::Explained& said, bool with_history) {
  for (std::size_t i = 0; i < said.frame.corners_px.size(); ++i) {
    files::Json json = json_of(said, i);
    if (!with_history) json.erase("history");
    print_out("{}\n", json.dump());
  }
}

ExitCode explain(const ExplainOptions& options) {
  const bool is_of_all = !options.track && !options.x_px;
  if (is_of_all && (!options.json || !options.picture.empty())) {
    throw std::invalid_argument(
        "give the corner by X and Y, or by --track; only --json is of all corners, without a "
        "picture");
  }
  if (!options.frame && options.track)
    throw std::invalid_argument("give FRAME, in which --track names the corner");
  explain::with_frames(options.run);
  explain::Explainer explainer(options.run, parameters_of(options.run));
  std::uint64_t frames = 0;
  while (frames <= options.frame.value_or(frames) && explainer.next()) {
    check_interrupted();
    ++frames;
    if (!options.frame) print_all(explainer.frame(), false);
  }
  if (!options.frame) return kFine;
  if (frames <= *options.frame) {
    throw std::runtime_error(
        fmt::format("{} has no frame {}; give one below {}", options.run, *options.frame, frames));
  }
  const explain::Explained& said = explainer.frame();
  if (is_of_all) {
    print_all(said, true);
    return kFine;
  }
  const std::size_t corner = corner_of(options, said);
  if (!options.picture.empty() && said.track_of[corner] != 0) write_picture(options, said, corner);
  print_out("{}", options.json ? json_of(said, corner).dump() + "\n"
                               : text_of(said, corner) + history_text(said, corner));
  return kFine;
}

app::Options options_of(ExplainOptions& options) {
  app::Options all("explain");
  all.add("RUN", "", &options.run, "Folder of a run", {.is_required = true});
  all.add("FRAME", "", &options.frame, "Number of a frame, from 0");
  all.add("X", "", &options.x_px, "Column of the corner, px", {.needs = "Y"});
  all.add("Y", "", &options.y_px, "Row of the corner, px");
  all.add("--track", "N", &options.track, "The corner on this track, in place of X and Y",
          {.excludes = "X"});
  all.add(
      "--json", "", &options.json,
      "Print a JSON object; without X, Y and --track a line for each corner of the frame, without "
      "FRAME of all frames");
  all.add("--picture", "FILE", &options.picture, "Write a picture too (PNG)", {.is_output = true});
  all.add_force(options.force);
  return all;
}

}  // namespace

Command explain_command() {
  return command_of("Explain why the filter called a corner of a run a rebel, or did not",
                    kExplainHelp, &explain);
}

}  // namespace lcs::tools
