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
  bool json = false;
  std::string picture;  ///< PNG file; "": none
  bool force = false;
};

/// A corner of a track in a frame.
struct Sighting {
  int frame;
  std::size_t corner;  ///< index in the frame
  Verdict verdict;
  sim::CornerTruth truth;
  Explanation why;
};

struct Explained {
  recording::RunInfo run;
  FieldParameters field;
  recording::FrameRecord frame;                  ///< that is asked for
  std::vector<scoring::CornerOutcome> outcomes;  ///< of its corners
  std::size_t corner = 0;                        ///< that is asked for
  std::map<Id, std::vector<Sighting>> tracks;    ///< that live then, with their sightings
  /// The sightings of the corner's track; empty if the filter has left the corner out.
  std::vector<Sighting> history;

  Vec2 place_px(std::size_t i) const { return frame.corners_px[i].cast<double>(); }
  /// Sets the corner that is asked for. \return whether it has a track.
  bool ask_for(std::size_t i) {
    corner = i;
    history.clear();
    for (const auto& [track, sightings] : tracks) {
      const Sighting& last = sightings.back();
      if (last.frame == frame.index && last.corner == i) history = sightings;
    }
    return !history.empty();
  }
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

/// The radius of FAST's circle.
constexpr double kNear_px = 3;

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
  said.field = plain->field;
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
          {frame.index, i, frame.verdicts[i], frame.corner_truth[i], *why});
    }
    std::erase_if(said.tracks, [&](const auto& track) {
      return track.second.back().frame + plain->edge.coast < frame.index;  // it has ended
    });
  }
  if (options.x_px) said.ask_for(corner_at({*options.x_px, *options.y_px}, frame));
  if (options.track) {
    const auto found = said.tracks.find(*options.track);
    if (found == said.tracks.end() || found->second.back().frame != frame.index) {
      throw std::runtime_error(
          fmt::format("no corner of the frame is on track {}; give X and Y", *options.track));
    }
    said.ask_for(found->second.back().corner);
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

constexpr std::array kOutcomes{"not counted", "right",  "false",        "right",
                               "right",       "missed", "missed, early"};

/// What makes the corner hard, by its truth and by that of its last sighting.
std::string kind_of(const Explained& said) {
  constexpr std::array kKinds{"at the outline of a mover", "radial", "seen first", "tracked"};
  const scoring::Difficulty kind = scoring::difficulty(said.frame, said.corner);
  const std::size_t sightings = said.history.size();
  if (kind != scoring::Difficulty::tracked || sightings < 2) return word(kKinds, kind);
  const Sighting &now = said.history[sightings - 1], &was = said.history[sightings - 2];
  if (was.frame + 1 != now.frame || was.truth.label == sim::Label::none) return word(kKinds, kind);
  const double off_px = (was.why.place_px() + was.truth.motion_px - now.why.place_px()).norm();
  if (off_px > kNear_px) {
    return fmt::format("a wrong match: the point that it followed is {:.1f} px away", off_px);
  }
  const auto static_px = [&](const EgoMotion& motion) {
    const MotionField field(*said.run.camera, motion, said.field);
    const double ratio = field.reference_depth_m() / was.truth.depth_m;
    return field.translated(field.rotated(was.why.place_px()), field.advanced_ratio(ratio));
  };
  const double told_px = (static_px(said.frame.motion) - static_px(said.frame.true_motion)).norm();
  constexpr double kDistinct_px = 1;  // from which on the truth calls a motion a rebel's
  if (told_px < kDistinct_px) return word(kKinds, kind);
  return fmt::format("told motion: it is off by {:.1f} px here", told_px);
}

/// Verdict and truth.
std::string heading(const Explained& said) {
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
      word(kOutcomes, said.outcomes[i]), kind_of(said));
}

/// The places of corners that are seen once, and have the m of this one (19).
std::vector<Vec2> told_px(const Explained& said) {
  const Sighting& now = said.history.back();
  std::vector<Vec2> places;
  for (const auto& [track, sightings] : said.tracks) {
    const Sighting& other = sightings.back();
    const auto& [seen, is] = std::tie(other.why.seen, now.why.seen);
    if (is[kSightings] < 2 && is[kBelief] != 0 && other.frame == now.frame &&
        seen[kSightings] >= 2 && seen[kBelief] == is[kBelief]) {
      places.push_back(other.why.place_px());
    }
  }
  return places;
}

int rule_of(Reason reason) {
  return reason == Reason::comer ? 29 : reason == Reason::goer ? 30 : 20;
}

/// A line for each number, with its equation.
std::string numbers_text(const Explained& said) {
  const Explanation& why = said.history.back().why;
  std::string text = fmt::format("track    {}, age {} frames\n", why.track, why.age);
  for (const auto& [equation, name, values] : numbers_of(why)) {
    text +=
        fmt::format("{:<8} {} = {}\n", equation, name,
                    values.size() == 1 ? text_of(values[0]) : text_of(Vec2(values[0], values[1])));
  }
  if (why.assigned != 0 && why.assigned != why.track) {
    text += fmt::format("(15)     fits neither: track {} ends, another begins\n", why.assigned);
  }
  for (const auto& [corner, weight, belief] : why.voices) {
    text += fmt::format("(19)     k = {:.4f}, tanh(m/2) = {:+.4f} of {}\n", weight, belief,
                        text_of(said.place_px(static_cast<std::size_t>(corner))));
  }
  for (const Vec2& place : told_px(said)) {
    text += fmt::format("(19)     corner with this m = {}\n", text_of(place));
  }
  const Reason reason = said.frame.reasons[said.corner];
  return text + fmt::format("({})     {}\n", rule_of(reason), text_of(reason).word);
}

std::string history_text(const Explained& said) {
  std::string text = "frame  miss static  miss moving       L       m  verdict\n";
  for (const Sighting& one : said.history) {
    text += fmt::format("{:5}  {:>11}  {:>11}  {:6.2f}  {:6.2f}  {}{}\n", one.frame,
                        text_of(one.why.miss_px(kStaticX)), text_of(one.why.miss_px(kMovingX)),
                        one.why.seen[kLogOdds], one.why.seen[kBelief],
                        word(recording::kVerdicts, one.verdict), said.on(one.truth.object));
  }
  return text;
}

// ---- JSON

files::Json xy(const Vec2& x) {
  return {x.x(), x.y()};
}

/// The corner's numbers, with those that are not there as null.
files::Json json_of(const Explained& said) {
  const std::size_t i = said.corner;
  const auto& [frame, truth] = std::tie(said.frame, said.frame.corner_truth[i]);
  files::Json json{{"frame", frame.index},
                   {"t_ns", frame.t_ns},
                   {"corner", i},
                   {"place_px", xy(said.place_px(i))},
                   {"verdict", word(recording::kVerdicts, frame.verdicts[i])},
                   {"reason", text_of(frame.reasons[i]).word},
                   {"truth", word(recording::kLabels, truth.label)},
                   {"object", truth.object},
                   {"outcome", word(kOutcomes, said.outcomes[i])},
                   {"kind", kind_of(said)}};
  if (said.history.empty()) return json;
  const Explanation& why = said.history.back().why;
  json["track"] = why.track;
  json["age"] = why.age;
  json["assigned"] = why.assigned;
  json["rule"] = rule_of(frame.reasons[i]);
  for (const auto& [equation, name, values] : numbers_of(why)) {
    json["numbers"][name] = values.size() == 1 ? files::Json(values[0]) : files::Json(values);
  }
  json["neighbours"] = files::Json::array();
  for (const auto& [corner, weight, belief] : why.voices) {
    json["neighbours"].push_back({{"corner", corner}, {"k", weight}, {"tanh(m/2)", belief}});
  }
  for (const Sighting& one : said.history) {
    json["history"].push_back({{"frame", one.frame},
                               {"place_px", xy(one.why.place_px())},
                               {"miss_static_px", one.why.miss_px(kStaticX)},
                               {"miss_moving_px", one.why.miss_px(kMovingX)},
                               {"L", one.why.seen[kLogOdds]},
                               {"m", one.why.seen[kBelief]},
                               {"verdict", word(recording::kVerdicts, one.verdict)},
                               {"object", one.truth.object}});
  }
  return json;
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
    dot(one.frame, one.why.miss_px(kStaticX), colour::kNormalEdge);
    dot(one.frame, one.why.miss_px(kMovingX), colour::kRebel);
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
    const Vec2 off = kZoom * (x - now.why.place_px());
    return middle + cv::Point(cvRound(off.x()), cvRound(off.y()));
  };
  cv::Mat3b picture(kHeight_px + kPlot_px, kWidth_px, cv::Vec3b::all(0));
  cv::Mat3b scene = picture.rowRange(0, kHeight_px), part;
  const cv::Point2d centre(now.why.place_px().x(), now.why.place_px().y());
  cv::getRectSubPix(image, scene.size() / kZoom, centre, part);
  cv::resize(part, scene, scene.size(), 0, 0, cv::INTER_CUBIC);
  for (const auto& [corner, weight, belief] : now.why.voices) {
    const double sure = std::abs(double{belief});
    const cv::Scalar ink = belief > 0 ? colour::kRebel : colour::kNormalEdge;
    cv::line(scene, middle, at(said.place_px(static_cast<std::size_t>(corner))),
             sure * ink + (1 - sure) * kGrey, 1 + cvRound(5 * weight), cv::LINE_AA);
  }
  const auto cross = [&](TrackColumn x, const cv::Scalar& ink) {
    if (std::isnan(now.why.miss_px(x))) return;
    for (const auto& [each, width] : {std::pair(kWhite, 5), std::pair(ink, 2)}) {
      cv::drawMarker(scene, at(now.why.predicted_px(x)), each, cv::MARKER_TILTED_CROSS, 16, width);
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
  const bool is_of_all = !options.track && !options.x_px;
  if (is_of_all && (!options.json || !options.picture.empty())) {
    throw std::invalid_argument(
        "give the corner by X and Y, or by --track; only --json is of all corners, without a "
        "picture");
  }
  Explained said = explained(options);
  for (std::size_t i = 0; is_of_all && i < said.frame.corners_px.size(); ++i) {
    said.ask_for(i);
    print_out("{}\n", json_of(said).dump());
  }
  if (is_of_all) return kFine;
  if (!options.picture.empty() && !said.history.empty()) write_picture(options, said);
  if (options.json) {
    print_out("{}\n", json_of(said).dump());
    return kFine;
  }
  if (said.history.empty()) {  // its reason says why it was left out
    print_out("{}", heading(said));
    return kFine;
  }
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
  all.add("--json", "", &options.json,
          "Print a JSON object; without X, Y and --track a line for each corner of the frame");
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
