#include "tools/recording/difference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <utility>

#include "tools/files/json_node.h"
#include "tools/recording/recording_fields.h"
#include "tools/recording/recording_io.h"

namespace lcs::recording {
namespace {

/// Adds the names of the members that differ between two lines; of a list, of few columns too.
void add_names(const std::string& before, const std::string& after, const std::string& prefix,
               std::vector<std::string>& parts) {
  std::map<std::string, std::set<std::string>> columns;
  const auto patch = nlohmann::json::diff(files::parse_json<nlohmann::json>(before),
                                          files::parse_json<nlohmann::json>(after));
  for (const nlohmann::json& change : patch) {
    const auto path = change.at("path").get<std::string>();  // such as "/corners/verdict/17"
    static const std::regex kNames("/([^/]+)(/[a-z][^/]*)?.*");
    std::smatch names;
    if (std::regex_match(path, names, kNames)) columns[names.str(1)].insert(names.str(2));
  }
  constexpr std::size_t kMostColumns = 3;
  for (const auto& [name, own] : columns) {
    const bool is_few = own.size() <= kMostColumns;
    const std::string listed = is_few ? fmt::format("{}", fmt::join(own, "")) : "";
    parts.push_back(fmt::format("{}{}{}", prefix, name, listed));
  }
}

/// What a detector said of each corner, by row and column.
std::map<std::pair<float, float>, std::string> beliefs_of(const FrameRecord& frame) {
  std::map<std::pair<float, float>, std::string> beliefs;
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    std::string& text = beliefs[{frame.corners_px[i].y(), frame.corners_px[i].x()}];
    text = kVerdicts.at(static_cast<std::size_t>(frame.verdicts.at(i)));
    const Reason reason = frame.reasons.empty() ? Reason::unknown : frame.reasons.at(i);
    if (reason != Reason::unknown) text += fmt::format(" by {}", text_of(reason).word);
    if (!frame.log_odds.empty()) text += fmt::format(", log odds {:.2f}", frame.log_odds.at(i));
  }
  return beliefs;
}

std::vector<CornerDifference> corners_of(const FrameRecord& before, const FrameRecord& after) {
  const auto was = beliefs_of(before), is = beliefs_of(after);
  auto all = was;
  all.insert(is.begin(), is.end());
  std::vector<CornerDifference> corners;
  for (const auto& [place, any] : all) {
    const auto in = [&](const auto& beliefs) {
      return beliefs.contains(place) ? beliefs.at(place) : "no corner";
    };
    if (in(was) != in(is)) corners.push_back({{place.second, place.first}, in(was), in(is)});
  }
  std::ranges::stable_partition(corners, [](const CornerDifference& corner) {
    const auto verdict = [](const std::string& text) { return text.substr(0, text.find(' ')); };
    return verdict(corner.before) != verdict(corner.after);
  });
  return corners;
}

/// A recording's frames, with the lines that they would be stored as.
struct Lines {
  RecordingReader reader;
  bool is_there = false;
  FrameRecord frame = {};
  std::string layers = {}, truth = {};

  void next() {
    is_there = reader.next(frame);
    layers = is_there ? layers_line(frame) : "";
    truth = is_there ? truth_line(frame) : "";
  }
};

}  // namespace

Difference difference_of(const std::filesystem::path& before, const std::filesystem::path& after) {
  Lines was{RecordingReader(before)}, is{RecordingReader(after)};
  Difference found;
  for (was.next(), is.next(); was.is_there || is.is_there; was.next(), is.next()) {
    ++found.frames;
    if (was.layers == is.layers && was.truth == is.truth) continue;
    ++found.differing;
    if (found.first) continue;
    const FrameRecord& frame = was.is_there ? was.frame : is.frame;
    FrameDifference& first = found.first.emplace();
    first.frame = frame.index;
    first.t_ns = frame.t_ns;
    if (was.is_there && is.is_there) {
      add_names(was.layers, is.layers, "", first.parts);
      add_names(was.truth, is.truth, "truth/", first.parts);
      first.corners = corners_of(was.frame, is.frame);
    } else {
      first.parts.emplace_back("frame");
    }
    if (was.is_there) first.before = was.frame;
    if (is.is_there) first.after = is.frame;
  }
  return found;
}

}  // namespace lcs::recording
