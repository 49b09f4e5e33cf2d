#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"
#include "tools/scoring/events.h"

namespace lcs::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr input::FileKind kEventsDocument{kMostJsonBytes, "run the scenario again"};

Json json_of(const EventView& view) {
  return {{"frame", view.frame},
          {"t_s", view.t_s},
          {"x", view.centre_px.x()},
          {"y", view.centre_px.y()},
          {"half_width", view.half_size_px.x()},
          {"half_height", view.half_size_px.y()},
          {"jpeg_base64", view.jpeg_base64}};
}

Json json_of(const Event& event) {
  Json json = {{"kind", text_of(event.kind).word}, {"first_frame", event.first_frame},
               {"last_frame", event.last_frame},   {"object", event.object},
               {"object_name", event.object_name}, {"corners", event.corners},
               {"of", event.counted_corners},      {"radial", event.radial_corners},
               {"circles", event.circles},         {"frames", event.frames},
               {"of_frames", event.of_frames},     {"reasons", Json::object()},
               {"steps", Json::object()},          {"views", Json::array()}};
  for (const auto& [reason, corners] : event.reasons) {
    json["reasons"][lcs::text_of(reason).word] = corners;
  }
  for (const auto& [step, corners] : event.steps) json["steps"][text_of(step).word] = corners;
  for (const EventView& view : event.views) json["views"].push_back(json_of(view));
  return json;
}

template <class Enum>
Enum enumerator_of(const JsonNode& node, const std::string& word, int count) {
  for (int i = 0; i < count; ++i) {
    if (text_of(static_cast<Enum>(i)).word == word) return static_cast<Enum>(i);
  }
  node.require(false, fmt::format("a word that is known here: '{}'", word));
  return {};
}

EventView view_of(const JsonNode& node) {
  EventView view;
  view.frame = node["frame"].natural<int>();
  view.t_s = node["t_s"].number();
  view.centre_px = {node["x"].number(), node["y"].number()};
  view.half_size_px = {node["half_width"].number(), node["half_height"].number()};
  view.jpeg_base64 = node["jpeg_base64"].text();
  return view;
}

Event event_of(const JsonNode& node) {
  Event event;
  event.kind = enumerator_of<EventKind>(node["kind"], node["kind"].text(),
                                        static_cast<int>(EventKind::square_false) + 1);
  event.first_frame = node["first_frame"].natural<int>();
  event.last_frame = node["last_frame"].natural<int>();
  event.object = node["object"].natural<int>();
  event.object_name = node["object_name"].text();
  event.corners = node["corners"].natural<int>();
  event.counted_corners = node["of"].natural<int>();
  // Absent in files of an earlier version, as the steps are.
  if (node.has("radial")) event.radial_corners = node["radial"].natural<int>();
  event.circles = node["circles"].natural<int>();
  node["reasons"].each_entry([&](const std::string& word, const JsonNode& corners) {
    event.reasons.emplace_back(
        enumerator_of<Reason>(corners, word, static_cast<int>(kReasons.size())),
        corners.natural<int>());
  });
  if (node.has("steps")) {  // absent in files of an earlier version
    event.frames = node["frames"].natural<int>();
    event.of_frames = node["of_frames"].natural<int>();
    node["steps"].each_entry([&](const std::string& word, const JsonNode& corners) {
      event.steps.emplace_back(
          enumerator_of<SquareStep>(corners, word, static_cast<int>(SquareStep::in_square) + 1),
          corners.natural<int>());
    });
  }
  node["views"].each([&](const JsonNode& view) { event.views.push_back(view_of(view)); });
  return event;
}

std::vector<Event> events_in(const JsonNode& document) {
  std::vector<Event> events;
  document["events"].each([&](const JsonNode& event) { events.push_back(event_of(event)); });
  return events;
}

}  // namespace

void write_events(const std::filesystem::path& file, const std::vector<Event>& events,
                  const EventSums& sums) {
  const auto by_word = [](const auto& counts) {
    Json json = Json::object();
    for (const auto& [cause, count] : counts) json[text_of(cause).word] = count;
    return json;
  };
  Json list = Json::array();
  for (const Event& event : events) list.push_back(json_of(event));
  // A name may hold any bytes, but JSON must be UTF-8.
  const Json all{{"events", list},
                 {"sums",
                  {{"missed", by_word(sums.missed)},
                   {"false", by_word(sums.false_ones)},
                   {"squares", by_word(sums.squares)}}}};
  write_file(file, json_text(all, 1) + '\n');
}

std::vector<Event> read_events(const std::filesystem::path& file) {
  return read_json(file, kEventsDocument, events_in);
}

EventSums read_event_sums(const std::filesystem::path& file) {
  return read_json(file, kEventsDocument, [](const JsonNode& node) {
    if (!node.has("sums")) return sums_of(events_in(node));
    EventSums sums;
    const auto read = [&](const char* key, auto& counts, auto last) {
      node["sums"][key].each_entry([&](const std::string& word, const JsonNode& count) {
        counts[enumerator_of<decltype(last)>(count, word, static_cast<int>(last) + 1)] =
            count.natural<int>();
      });
    };
    constexpr auto kLastReason = static_cast<Reason>(kReasons.size() - 1);
    read("missed", sums.missed, kLastReason);
    read("false", sums.false_ones, kLastReason);
    read("squares", sums.squares, EventKind::square_false);
    return sums;
  });
}

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      bits = bits << 8 | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? kDigits[bits >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

}  // namespace lcs::bench
