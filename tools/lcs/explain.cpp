/// \file
/// `lcs explain`: the numbers by which the filter called a corner of a run a rebel, or did not.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
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
#include "tools/output/panels.h"
#include "tools/sequence/png.h"

namespace lcs::tools {
namespace {

namespace colour = output::colour;

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
  const auto found = std::ranges::find_if(
      said.why, [&](const auto& why) { return why && why->track == options.track; });
  if (found != said.why.end()) return static_cast<std::size_t>(found - said.why.begin());
  throw std::runtime_error(
      fmt::format("no corner of the frame is on track {}; give X and Y", *options.track));
}

constexpr int kWidth_px = 768, kHeight_px = 576, kPlot_px = 180;
const cv::Scalar kGrey = cv::Scalar::all(120), kWhite = cv::Scalar::all(255);

/// The values of the history as dots over its frames.
void plot(std::span<const explain::Sighting> history, cv::Mat3b strip) {
  constexpr double kMost = 12;  // ends of the strip, at which values are cut off
  const int first = history.front().frame, frames = history.back().frame - first;
  const auto dot = [&](int frame, double value, const cv::Scalar& ink) {
    const double x = 8 + (strip.cols - 16.0) * (frame - first) / std::max(1, frames);
    const double y = (0.5 - 0.45 * std::clamp(value / kMost, -1.0, 1.0)) * strip.rows;
    if (!std::isnan(value)) cv::circle(strip, {cvRound(x), cvRound(y)}, 3, ink, cv::FILLED);
  };
  cv::line(strip, {0, strip.rows / 2}, {strip.cols, strip.rows / 2}, kGrey);
  cv::putText(strip, "-12 to 12: L grey, m white; misses in px, static blue, moving red",
              {8, strip.rows - 8}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kWhite, 1, cv::LINE_AA);
  for (const explain::Sighting& one : history) {
    dot(one.frame, one.miss_static_px, colour::kNormalEdge);
    dot(one.frame, one.miss_moving_px, colour::kRebel);
    dot(one.frame, double{one.log_odds}, kGrey);
    dot(one.frame, double{one.belief}, kWhite);
  }
}

/// The surroundings of the corner with its predictions and neighbours; below, its history.
/// \param corner has a track. \param image of the frame, BGR.
cv::Mat3b picture_of(const explain::Explained& said, std::size_t corner, const cv::Mat3b& image) {
  constexpr int kZoom = 6;
  const Explanation& now = said.why[corner].value();
  const cv::Point middle(kWidth_px / 2, kHeight_px / 2);
  const auto at = [&](const Vec2& x) {
    const Vec2 off = kZoom * (x - now.place_px());
    return middle + cv::Point(cvRound(off.x()), cvRound(off.y()));
  };
  cv::Mat3b picture(kHeight_px + kPlot_px, kWidth_px, cv::Vec3b::all(0));
  cv::Mat3b scene = picture.rowRange(0, kHeight_px), part;
  const cv::Point2d centre(now.place_px().x(), now.place_px().y());
  cv::getRectSubPix(image, scene.size() / kZoom, centre, part);
  cv::resize(part, scene, scene.size(), 0, 0, cv::INTER_CUBIC);
  for (const auto& [neighbour, weight, belief] : now.voices) {
    const double sure = std::abs(double{belief});
    const cv::Scalar ink = belief > 0 ? colour::kRebel : colour::kNormalEdge;
    cv::line(scene, middle, at(said.place_px(static_cast<std::size_t>(neighbour))),
             sure * ink + (1 - sure) * kGrey, 1 + cvRound(5 * weight), cv::LINE_AA);
  }
  const auto cross = [&](TrackColumn x, const cv::Scalar& ink) {
    if (std::isnan(now.miss_px(x))) return;
    for (const auto& [each, width] : {std::pair(kWhite, 5), std::pair(ink, 2)}) {
      cv::drawMarker(scene, at(now.predicted_px(x)), each, cv::MARKER_TILTED_CROSS, 16, width);
    }
  };
  cv::circle(scene, middle, 7, kWhite, 2, cv::LINE_AA);
  cross(kStaticX, colour::kNormalEdge);
  cross(kMovingX, colour::kRebel);
  plot(said.history(corner), picture.rowRange(kHeight_px, picture.rows));
  return picture;
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
  if (!options.picture.empty() && said.why[corner]) write_picture(options, said, corner);
  print_out("{}", options.json ? json_of(said, corner).dump() + "\n"
                               : text_of(said, corner) + history_text(said, corner));
  return kFine;
}

app::Options options_of(ExplainOptions& options) {
  app::Options all("explain");
  all.add("RUN", "", &options.run, {.is_required = true});
  all.add("FRAME", "", &options.frame);
  all.add("X", "", &options.x_px, {.needs = "Y"});
  all.add("Y", "", &options.y_px);
  all.add("--track", "N", &options.track, {.excludes = "X"});
  all.add("--json", "", &options.json);
  all.add("--picture", "FILE", &options.picture, {.is_output = true});
  all.add_force(options.force);
  return all;
}

}  // namespace

Command explain_command() {
  return command_of("Explain why the filter called a corner of a run a rebel, or did not",
                    kExplainHelp, &explain);
}

}  // namespace lcs::tools
