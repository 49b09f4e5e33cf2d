// Explanations as text and JSON.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "tools/explain/explainer.h"
#include "tools/files/json_node.h"
#include "tools/recording/recording_fields.h"

namespace lcs::explain {
namespace {

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

std::string on(const Explained& said, int object) {
  const auto named = std::ranges::find(said.run.objects, object, &sim::Object::id);
  return named == said.run.objects.end() ? "" : " on " + named->name;
}

/// What makes the corner hard, by its truth and by that of its last sighting.
std::string kind_of(const Explained& said, std::size_t corner) {
  constexpr std::array kKinds{"at the outline of a mover", "radial", "seen first", "tracked"};
  const scoring::Difficulty kind = scoring::difficulty(said.frame, corner);
  const std::span<const Sighting> history = said.history(corner);
  const std::size_t sightings = history.size();
  if (kind != scoring::Difficulty::tracked || sightings < 2) return word(kKinds, kind);
  const Sighting &now = history[sightings - 1], &was = history[sightings - 2];
  if (was.frame + 1 != now.frame || was.truth.label == sim::Label::none) return word(kKinds, kind);
  const double off_px = (was.place_px + was.truth.motion_px - now.place_px).norm();
  constexpr double kFollowed_px = 3;  // the radius of FAST's circle
  if (off_px > kFollowed_px) {
    return fmt::format("a wrong match: the point that it followed is {:.1f} px away", off_px);
  }
  const auto static_px = [&](const EgoMotion& motion) {
    const MotionField field(*said.run.camera, motion, said.field);
    const double ratio = field.reference_depth_m() / was.truth.depth_m;
    return field.translated(field.rotated(was.place_px), field.advanced_ratio(ratio));
  };
  const double told_px = (static_px(said.frame.motion) - static_px(said.frame.true_motion)).norm();
  constexpr double kDistinct_px = 1;  // from which on the truth calls a motion a rebel's
  if (told_px < kDistinct_px) return word(kKinds, kind);
  return fmt::format("told motion: it is off by {:.1f} px here", told_px);
}

/// Verdict and truth.
std::string heading(const Explained& said, std::size_t i) {
  const sim::CornerTruth& truth = said.frame.corner_truth[i];
  const ReasonText& reason = text_of(said.frame.reasons[i]);
  return fmt::format(
      "{} frame {} ({:.3f} s), corner {}\n"
      "verdict  {} by {}: {}\n"
      "truth    {}{}: {}, {}\n",
      said.run.scenario, said.frame.index, static_cast<double>(said.frame.t_ns) * 1e-9,
      text_of(said.place_px(i)), word(recording::kVerdicts, said.frame.verdicts[i]), reason.word,
      reason.meaning, word(recording::kLabels, truth.label), on(said, truth.object),
      word(kOutcomes, said.outcomes[i]), kind_of(said, i));
}

/// The places of corners that are seen once, and have the m of this one (19).
std::vector<Vec2> told_px(const Explained& said, const Explanation& why) {
  std::vector<Vec2> places;
  for (const std::optional<Explanation>& other : said.why) {
    const auto& is = why.seen;
    if (other && is[kSightings] < 2 && is[kBelief] != 0 && other->seen[kSightings] >= 2 &&
        other->seen[kBelief] == is[kBelief]) {
      places.push_back(other->place_px());
    }
  }
  return places;
}

int rule_of(Reason reason) {
  return reason == Reason::comer ? 29 : reason == Reason::goer ? 30 : 20;
}

/// A line for each number, with its equation.
std::string numbers_text(const Explained& said, std::size_t i) {
  const Explanation& why = said.why[i].value();
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
  for (const Vec2& place : told_px(said, why)) {
    text += fmt::format("(19)     corner with this m = {}\n", text_of(place));
  }
  const Reason reason = said.frame.reasons[i];
  return text + fmt::format("({})     {}\n", rule_of(reason), text_of(reason).word);
}

files::Json xy(const Vec2& x) {
  return {x.x(), x.y()};
}

}  // namespace

std::string text_of(const Explained& said, std::size_t corner) {
  std::string text = heading(said, corner);
  if (said.why[corner]) text += numbers_text(said, corner);
  return text;  // the reason of a corner that was left out says why
}

std::string verdict_text(const Explained& said, const Sighting& one) {
  return word(recording::kVerdicts, one.verdict) + on(said, one.truth.object);
}

std::string history_text(const Explained& said, std::size_t corner) {
  const std::span<const Sighting> history = said.history(corner);
  if (history.empty()) return "";
  std::string text = "frame  miss static  miss moving       L       m  verdict\n";
  for (const Sighting& one : history) {
    text += fmt::format("{:5}  {:>11}  {:>11}  {:6.2f}  {:6.2f}  {}\n", one.frame,
                        text_of(one.miss_static_px), text_of(one.miss_moving_px), one.log_odds,
                        one.belief, verdict_text(said, one));
  }
  return text;
}

files::Json json_of(const Explanation& why) {
  files::Json json{{"track", why.track}, {"age", why.age}, {"assigned", why.assigned}};
  for (const auto& [equation, name, values] : numbers_of(why)) {
    json["numbers"][name] = values.size() == 1 ? files::Json(values[0]) : files::Json(values);
  }
  json["neighbours"] = files::Json::array();
  for (const auto& [corner, weight, belief] : why.voices) {
    json["neighbours"].push_back({{"corner", corner}, {"k", weight}, {"tanh(m/2)", belief}});
  }
  return json;
}

files::Json json_of(const Explained& said, std::size_t i) {
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
                   {"kind", kind_of(said, i)}};
  if (!said.why[i]) return json;
  json.update(json_of(*said.why[i]));
  json["rule"] = rule_of(frame.reasons[i]);
  for (const Sighting& one : said.history(i)) {
    json["history"].push_back({{"frame", one.frame},
                               {"place_px", xy(one.place_px)},
                               {"miss_static_px", one.miss_static_px},
                               {"miss_moving_px", one.miss_moving_px},
                               {"L", one.log_odds},
                               {"m", one.belief},
                               {"verdict", word(recording::kVerdicts, one.verdict)},
                               {"object", one.truth.object}});
  }
  return json;
}

}  // namespace lcs::explain
