/// \file
/// `lcs explain`: the numbers by which the filter called a corner of a run a rebel, or did not.
#include "filter/edges/explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/bench/bench.h"
#include "tools/files/output.h"
#include "tools/files/provenance.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/terminal.h"
#include "tools/output/frame_pictures.h"
#include "tools/output/panels.h"
#include "tools/recording/recording_fields.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/score_rebels.h"
#include "tools/sequence/png.h"

namespace lcs::tools {
namespace {

namespace colour = output::colour;

struct ExplainOptions {
  std::string run;  ///< folder
  std::uint64_t frame = 0;
  std::optional<double> x_px, y_px;  ///< near the corner
  std::optional<Id> track;           ///< in place of x and y
  std::string picture;               ///< PNG file; "": none
  bool force = false;
};

constexpr const char* kExplainHelp = R"(Examples:
  lcs explain out/crossing 12 506 240                      the corner within 3 px of (506, 240) in frame 12
  lcs explain out/crossing 12 --track 345                  the corner on this track
  lcs explain out/crossing 12 506 240 --picture why.png    also as a picture

The filter goes over the frames of the run again, and has to come to the stored verdicts. Each number stands
behind its equation of filter/MODEL.md; the last lines are the sightings of the track. In the picture the line
to a neighbour is as wide as its weight, red if it said that it moves, blue if it stands.
)";

/// A corner of a track in a frame.
struct Sighting {
  int frame;
  std::size_t corner;  ///< index in the frame
  Verdict verdict;
  int object;
  Explanation why;

  Vec2 predicted_px(TrackColumn x) const { return {why.predicted[x], why.predicted[x + 1]}; }
  Vec2 place_px() const { return {why.seen[kPlaceX], why.seen[kPlaceY]}; }
  /// NaN without the prediction.
  double miss_px(TrackColumn x) const {
    const bool is_there = why.predicted[kSightings] >= (x == kMovingX ? 2 : 1);
    return is_there ? (place_px() - predicted_px(x)).norm() : std::nan("");
  }
};

struct Explained {
  recording::RunInfo run;
  recording::FrameRecord frame;                  ///< that is asked for
  std::vector<scoring::CornerOutcome> outcomes;  ///< of its corners
  std::size_t corner = 0;                        ///< that is asked for
  std::map<Id, std::vector<Sighting>> tracks;    ///< that live then, with their sightings
  /// The sightings of the corner's track; empty if the filter has left the corner out.
  std::vector<Sighting> history;

  Vec2 place_px(std::size_t i) const { return frame.corners_px[i].cast<double>(); }
  std::string on(int object) const {
    const auto named = std::ranges::find(run.objects, object, &sim::Object::id);
    return named == run.objects.end() ? "" : " on " + named->name;
  }
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

/// Steps the filter, and requires that it judges the corners as stored.
void step(const recording::FrameRecord& frame, const std::string& run,
          bench::LcsDetector& detector) {
  recording::FrameRecord again = recording::without_detections(frame);
  bench::run_detector(detector, {}, {}, again);
  if (again.verdicts == frame.verdicts && again.reasons == frame.reasons &&
      again.log_odds == frame.log_odds) {
    return;
  }
  throw std::runtime_error(
      fmt::format("{}: the verdicts in frame {} are not this filter's; another version or another "
                  "filter made the run, or it was edited: make it again",
                  run, frame.index));
}

/// The index of the corner nearest to a place. \throws std::runtime_error if none is near.
std::size_t corner_at(const Vec2& place_px, const recording::FrameRecord& frame) {
  constexpr double kNear_px = 3;
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

Explained explained(const ExplainOptions& options) {
  if (!std::filesystem::exists(recording::stored(options.run, recording::kLayersFile))) {
    throw std::runtime_error(options.run + " has no frames; name a run made with --keep all");
  }
  recording::RecordingReader reader(options.run);
  Explained said;
  said.run = reader.run();
  const AnyParameters parameters = parameters_of(options.run);
  const auto* const plain = std::get_if<Parameters>(&parameters);
  if (!said.run.detector.layered || !said.run.camera || plain == nullptr) {
    throw std::runtime_error(options.run +
                             " is no run of the default filter with its camera, which alone can be "
                             "explained; run the scenario with --detector lcs:default");
  }
  bench::LcsDetector detector(*said.run.camera, parameters);
  const Filter& filter = *detector.filter().plain();
  scoring::RebelScorer scorer;
  const recording::FrameRecord& frame = said.frame;
  for (std::uint64_t k = 0; k <= options.frame; ++k) {
    check_interrupted();
    if (!reader.next(said.frame)) {
      throw std::runtime_error(
          fmt::format("{} has no frame {}; give one below {}", options.run, options.frame, k));
    }
    step(frame, options.run, detector);
    said.outcomes = scorer.add(frame).outcomes;
    for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
      const std::optional<Explanation> why = filter.explain(static_cast<int>(i));
      if (!why) continue;
      said.tracks[why->track].push_back(
          {frame.index, i, frame.verdicts[i], frame.corner_truth[i].object, *why});
    }
    std::erase_if(said.tracks, [&](const auto& track) {
      return track.second.back().frame + plain->edge.coast < frame.index;  // it has ended
    });
  }
  if (!options.track) said.corner = corner_at({*options.x_px, *options.y_px}, frame);
  for (const auto& [track, sightings] : said.tracks) {
    if (sightings.back().frame != frame.index) continue;
    const bool is_there = sightings.back().place_px() == said.place_px(said.corner);
    if (options.track ? track != *options.track : !is_there) continue;
    said.corner = sightings.back().corner;
    said.history = sightings;
  }
  if (options.track && said.history.empty()) {
    throw std::runtime_error(
        fmt::format("no corner of the frame is on track {}; give X and Y", *options.track));
  }
  return said;
}

// ---- Text

const char* word(const auto& words, auto value) {
  return words.at(static_cast<std::size_t>(value));
}

/// A number that is not there is a dash.
std::string text_of(double x) {
  return std::isnan(x) ? "-" : fmt::format("{:.4g}", x);
}

std::string text_of(const Vec2& x) {
  return fmt::format("({:.2f}, {:.2f})", x.x(), x.y());
}

/// Verdict and truth.
std::string heading(const Explained& said) {
  constexpr std::array kOutcomes{"not counted", "right",  "false",        "right",
                                 "right",       "missed", "missed, early"};
  constexpr std::array kKinds{"at the outline of a mover", "radial", "seen first", "tracked"};
  const std::size_t i = said.corner;
  const sim::CornerTruth& truth = said.frame.corner_truth[i];
  const ReasonText& reason = text_of(said.frame.reasons[i]);
  return fmt::format(
      "{} frame {} ({:.3f} s), corner {}\n"
      "verdict  {} by {}: {}\n"
      "truth    {}{}: {}, {}\n",
      said.run.scenario, said.frame.index, static_cast<double>(said.frame.t_ns) * 1e-9,
      text_of(said.place_px(i)), word(recording::kVerdicts, said.frame.verdicts[i]), reason.word,
      reason.meaning, word(recording::kLabels, truth.label), said.on(truth.object),
      word(kOutcomes, said.outcomes[i]), word(kKinds, scoring::difficulty(said.frame, i)));
}

/// A line for each number, with its equation.
std::string numbers_text(const Explained& said) {
  const Sighting& now = said.history.back();
  const Explanation& why = now.why;
  const auto& [was, is] = std::tie(why.predicted, why.seen);
  std::string text = fmt::format("track    {}, age {} frames\n", why.track, why.age);
  const auto add = [&](const char* equation, const char* name, const auto& value) {
    text += fmt::format("{:<8} {} = {}\n", equation, name, text_of(value));
  };
  if (why.assigned != 0) {
    add("(1)", "x_r, px", now.predicted_px(kPlaceX));
    add("(2), (4)", "x', px", now.predicted_px(kStaticX));
    add("(2), (4)", "w, 1/m", was[kInverseDepth_pm]);
    add("(12)", "deviation from x', px", Vec2(why.static_spread_px2.diagonal().cwiseSqrt()));
    add("(12)", "miss of x', px", now.miss_px(kStaticX));
    if (was[kSightings] >= 2) {
      add("(5)", "x'_M, px", now.predicted_px(kMovingX));
      add("(13)", "deviation from x'_M, px", std::sqrt(was[kMovingXx] + is[kSeenNoise2]));
      add("(13)", "miss of x'_M, px", now.miss_px(kMovingX));
    }
    add("(17)", "sigma, px", std::sqrt(is[kSeenNoise2]));
    add("(12)", "p_S, 1/px^2", is[kStaticDensity]);
    add("(13)", "p_M, 1/px^2", is[kMovingDensity]);
    add("(15)", "phi, 1/px^2", is[kWrongDensity]);
    add("(15)", "L'", is[kLogOddsBefore]);
  }
  if (why.assigned != 0 && why.assigned != why.track) {
    text += fmt::format("(15)     fits neither: track {} ends, another begins\n", why.assigned);
  }
  if (is[kSightings] >= 2) {
    add("(15)", "L", is[kLogOdds]);
    add("(34)", "L_C", why.shown);
    double all = 0, pull = 0;
    for (const auto& [corner, weight, belief] : why.voices) {
      all += double{weight};
      pull += double{weight} * double{belief};
      text += fmt::format("(19)     k = {:.4f}, tanh(m/2) = {:+.4f} of {}\n", weight, belief,
                          text_of(said.place_px(static_cast<std::size_t>(corner))));
    }
    add("(18)", "sum of k", all);
    add("(18)", "sum of k tanh(m/2)", pull);
    add("(18)", "m - L_C", is[kBelief] - why.shown);
  }
  for (const auto& [track, sightings] : said.tracks) {
    const Sighting& other = sightings.back();
    const bool is_told = is[kSightings] < 2 && is[kBelief] != 0 && other.frame == now.frame &&
                         other.why.seen[kSightings] >= 2 && other.why.seen[kBelief] == is[kBelief];
    if (is_told) add("(19)", "corner with this m", other.place_px());
  }
  add("(18)", "m", is[kBelief]);
  const Reason reason = said.frame.reasons[said.corner];
  const int rule = reason == Reason::comer ? 29 : reason == Reason::goer ? 30 : 20;
  return text + fmt::format("({})     {}\n", rule, text_of(reason).word);
}

std::string history_text(const Explained& said) {
  std::string text = "frame  miss static  miss moving       L       m  verdict\n";
  for (const Sighting& one : said.history) {
    text += fmt::format("{:5}  {:>11}  {:>11}  {:6.2f}  {:6.2f}  {}{}\n", one.frame,
                        text_of(one.miss_px(kStaticX)), text_of(one.miss_px(kMovingX)),
                        one.why.seen[kLogOdds], one.why.seen[kBelief],
                        word(recording::kVerdicts, one.verdict), said.on(one.object));
  }
  return text;
}

// ---- Picture

constexpr int kWidth_px = 768, kHeight_px = 576, kPlot_px = 180;
const cv::Scalar kGrey = cv::Scalar::all(120), kWhite = cv::Scalar::all(255);

/// The values of the history as dots over its frames.
void plot(const std::vector<Sighting>& history, cv::Mat3b strip) {
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
  for (const Sighting& one : history) {
    dot(one.frame, one.miss_px(kStaticX), colour::kNormalEdge);
    dot(one.frame, one.miss_px(kMovingX), colour::kRebel);
    dot(one.frame, double{one.why.seen[kLogOdds]}, kGrey);
    dot(one.frame, double{one.why.seen[kBelief]}, kWhite);
  }
}

/// The surroundings of the corner with its predictions and neighbours; below, its history.
/// \param image of the frame.
cv::Mat3b picture_of(const Explained& said, const cv::Mat3b& image) {
  constexpr int kZoom = 6;
  const Sighting& now = said.history.back();
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
  for (const auto& [corner, weight, belief] : now.why.voices) {
    const double sure = std::abs(double{belief});
    const cv::Scalar ink = belief > 0 ? colour::kRebel : colour::kNormalEdge;
    cv::line(scene, middle, at(said.place_px(static_cast<std::size_t>(corner))),
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
  plot(said.history, picture.rowRange(kHeight_px, picture.rows));
  return picture;
}

void write_picture(const ExplainOptions& options, const Explained& said) {
  const std::filesystem::path file = std::filesystem::path(options.run) / output::kPicturesFile;
  const cv::Size size(said.run.camera->width_px, said.run.camera->height_px);
  cv::Mat3b image(size, cv::Vec3b::all(0));
  const bool is_there = std::filesystem::exists(file);
  if (is_there) image = output::FramePictures(file, size).image(options.frame);
  files::Output picture(options.picture, files::overwrite(options.force));
  files::write_file(picture.staging(),
                    sequence::encode_png(picture_of(said, image), sequence::PngFilter::up));
  picture.commit();
  if (!is_there) tell(options.run + " has no pictures, only marks are drawn: --events keeps some");
}

ExitCode explain(const ExplainOptions& options) {
  if (!options.track && !options.x_px) {
    throw std::invalid_argument("give the corner by X and Y, or by --track");
  }
  const Explained said = explained(options);
  if (said.history.empty()) {  // its reason says why it was left out
    print_out("{}", heading(said));
    return kFine;
  }
  if (!options.picture.empty()) write_picture(options, said);
  print_out("{}{}{}", heading(said), numbers_text(said), history_text(said));
  return kFine;
}

app::Options options_of(ExplainOptions& options) {
  app::Options all("explain");
  all.add("RUN", "", &options.run, "Folder of a run", {.is_required = true});
  all.add("FRAME", "", &options.frame, "Number of a frame, from 0", {.is_required = true});
  all.add("X", "", &options.x_px, "Column of the corner, px", {.needs = "Y"});
  all.add("Y", "", &options.y_px, "Row of the corner, px");
  all.add("--track", "N", &options.track, "The corner on this track, in place of X and Y",
          {.excludes = "X"});
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
