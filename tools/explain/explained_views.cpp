#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/explain/explainer.h"
#include "tools/files/json_node.h"

namespace lcs::explain {
namespace {

/// With two decimals, as the text has; null if it is not there.
files::Json rounded(double x) {
  return std::isnan(x) ? files::Json(nullptr) : files::Json(std::round(100 * x) / 100);
}

files::Json prediction(const Explanation& why, TrackColumn x) {
  if (std::isnan(why.miss_px(x))) return nullptr;
  return {rounded(why.predicted_px(x).x()), rounded(why.predicted_px(x).y())};
}

files::Json corner_json(const Explained& said, std::size_t corner) {
  const Vec2 place = said.place_px(corner);
  files::Json json{{"x", place.x()}, {"y", place.y()}, {"text", text_of(said, corner)}};
  if (!said.why[corner]) return json;
  const Explanation& why = *said.why[corner];
  json["static"] = prediction(why, kStaticX);
  json["moving"] = prediction(why, kMovingX);
  for (const auto& [neighbour, weight, belief] : why.voices) {
    const Vec2 at = said.place_px(static_cast<std::size_t>(neighbour));
    json["neighbours"].push_back({at.x(), at.y(), rounded(weight), rounded(belief)});
  }
  for (const Sighting& one : said.history(corner)) {
    json["history"].push_back({one.frame, rounded(one.miss_static_px), rounded(one.miss_moving_px),
                               rounded(one.log_odds), rounded(one.belief),
                               verdict_text(said, one)});
  }
  return json;
}

/// Whether the picture of an event has a mark for it.
bool is_marked(scoring::CornerOutcome outcome) {
  using enum scoring::CornerOutcome;
  return outcome == found || outcome == found_early || outcome == false_rebel || outcome == missed;
}

bool shows(const scoring::EventView& view, const Vec2& place_px) {
  const Vec2 off = (place_px - view.centre_px).cwiseAbs();
  return off.x() <= view.half_size_px.x() && off.y() <= view.half_size_px.y();
}

}  // namespace

files::Json explained_views(const std::filesystem::path& run, const AnyParameters& parameters,
                            const std::vector<scoring::ScoredEvent>& events,
                            const std::function<void()>& check) {
  std::map<int, std::vector<const scoring::EventView*>> views;  // by frame
  for (const scoring::ScoredEvent& event : events) {
    if (family_of(event.kind) == scoring::EventFamily::squares) continue;  // marks no corners
    for (const scoring::EventView& view : event.views) {
      if (!view.jpeg_base64.empty()) views[view.frame].push_back(&view);
    }
  }
  files::Json all = files::Json::object();
  if (views.empty()) return all;
  Explainer explainer(run, parameters);
  const recording::FrameRecord& frame = explainer.frame().frame;
  std::size_t bytes = 0;
  while (bytes < kMostBytes && explainer.next()) {
    check();
    if (frame.index > views.rbegin()->first) break;
    const auto found = views.find(frame.index);
    if (found == views.end()) continue;
    const Explained& said = explainer.frame();
    files::Json corners = files::Json::array();
    for (std::size_t i = 0; i < said.outcomes.size(); ++i) {
      const bool is_shown = std::ranges::any_of(
          found->second, [&](const auto* view) { return shows(*view, said.place_px(i)); });
      if (!is_shown || !is_marked(said.outcomes[i])) continue;
      corners.push_back(corner_json(said, i));
      bytes += corners.back().dump().size();
    }
    if (!corners.empty()) all[std::to_string(frame.index)] = std::move(corners);
  }
  return all;
}

}  // namespace lcs::explain
