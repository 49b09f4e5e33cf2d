#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/bench/events.h"
#include "tools/bench/output_file.h"

namespace lcs::bench {
namespace {

using Json = nlohmann::ordered_json;

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
  Json json = {{"kind", text_of(event.kind).word},
               {"first_frame", event.first_frame},
               {"last_frame", event.last_frame},
               {"object", event.object},
               {"object_name", event.object_name},
               {"corners", event.corners},
               {"of", event.of},
               {"circles", event.circles},
               {"reasons", Json::object()},
               {"views", Json::array()}};
  for (const auto& [reason, corners] : event.reasons) {
    json["reasons"][lcs::text_of(reason).word] = corners;
  }
  for (const EventView& view : event.views) json["views"].push_back(json_of(view));
  return json;
}

template <class Enum>
Enum enumerator_of(const std::string& word, int count) {
  for (int i = 0; i < count; ++i) {
    if (text_of(static_cast<Enum>(i)).word == word) return static_cast<Enum>(i);
  }
  throw std::runtime_error("unknown word \"" + word + '"');
}

EventView view_of(const Json& json) {
  EventView view;
  json.at("frame").get_to(view.frame);
  json.at("t_s").get_to(view.t_s);
  json.at("x").get_to(view.centre_px.x());
  json.at("y").get_to(view.centre_px.y());
  json.at("half_width").get_to(view.half_size_px.x());
  json.at("half_height").get_to(view.half_size_px.y());
  json.at("jpeg_base64").get_to(view.jpeg_base64);
  return view;
}

Event event_of(const Json& json) {
  Event event;
  event.kind = enumerator_of<EventKind>(json.at("kind").get<std::string>(),
                                        static_cast<int>(EventKind::halo) + 1);
  json.at("first_frame").get_to(event.first_frame);
  json.at("last_frame").get_to(event.last_frame);
  json.at("object").get_to(event.object);
  json.at("object_name").get_to(event.object_name);
  json.at("corners").get_to(event.corners);
  json.at("of").get_to(event.of);
  json.at("circles").get_to(event.circles);
  for (const auto& [word, corners] : json.at("reasons").items()) {
    event.reasons.emplace_back(enumerator_of<Reason>(word, static_cast<int>(kReasons.size())),
                               corners.get<int>());
  }
  for (const Json& view : json.at("views")) event.views.push_back(view_of(view));
  return event;
}

}  // namespace

void write_events(const std::filesystem::path& file, const std::vector<Event>& events) {
  Json list = Json::array();
  for (const Event& event : events) list.push_back(json_of(event));
  OutputFile out(file);
  // A name may hold any bytes; JSON only UTF-8.
  out.write(Json{{"events", list}}.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
  out.close();
}

std::vector<Event> read_events(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  try {
    const Json json = Json::parse(stream);
    std::vector<Event> events;
    for (const Json& event : json.at("events")) events.push_back(event_of(event));
    return events;
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
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
