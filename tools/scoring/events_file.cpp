#include <openssl/evp.h>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"
#include "tools/scoring/events.h"

namespace lcs::scoring {
namespace {

constexpr input::FileKind kEventsDocument{files::kMostJsonBytes, "run the scenario again"};

files::Json json_of(const EventView& view) {
  return {{"frame", view.frame},
          {"t_s", view.t_s},
          {"x", view.centre_px.x()},
          {"y", view.centre_px.y()},
          {"half_width", view.half_size_px.x()},
          {"half_height", view.half_size_px.y()},
          {"jpeg_base64", view.jpeg_base64}};
}

/// \param counts pairs of a cause and a number.
template <class Counts>
files::Json by_word(const Counts& counts) {
  files::Json json = files::Json::object();
  for (const auto& [cause, count] : counts) json[text_of(cause).word] = count;
  return json;
}

constexpr auto kLastReason = static_cast<Reason>(kReasons.size() - 1);

/// \param last the last enumerator.
template <class Enum>
Enum enumerator_of(const files::JsonNode& node, const std::string& word, Enum last) {
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    if (text_of(static_cast<Enum>(i)).word == word) return static_cast<Enum>(i);
  }
  node.require(false, fmt::format("a word that is known here: '{}'", word));
  return {};
}

/// Reads an object of `by_word`, in the order of the file.
template <class Enum>
std::vector<std::pair<Enum, int>> counts_in(const files::JsonNode& node, Enum last) {
  std::vector<std::pair<Enum, int>> counts;
  node.each_entry([&](const std::string& word, const files::JsonNode& count) {
    counts.emplace_back(enumerator_of(count, word, last), count.natural<int>());
  });
  return counts;
}

EventView view_of(const files::JsonNode& node) {
  return {.frame = node["frame"].natural<int>(),
          .t_s = node["t_s"].number(),
          .centre_px = {node["x"].number(), node["y"].number()},
          .half_size_px = {node["half_width"].number(), node["half_height"].number()},
          .jpeg_base64 = node["jpeg_base64"].text()};
}

ScoredEvent event_of(const files::JsonNode& node) {
  ScoredEvent event;
  event.kind = enumerator_of(node["kind"], node["kind"].text(), EventKind::square_false);
  event.first_frame = node["first_frame"].natural<int>();
  event.last_frame = node["last_frame"].natural<int>();
  event.object = node["object"].natural<int>();
  event.object_name = node["object_name"].text();
  event.corners = node["corners"].natural<int>();
  event.counted_corners = node["of"].natural<int>();
  // Absent in files of an earlier version, as the steps are.
  if (node.has("radial")) event.radial_corners = node["radial"].natural<int>();
  event.circles = node["circles"].natural<int>();
  event.reasons = counts_in(node["reasons"], kLastReason);
  if (node.has("steps")) {  // absent in files of an earlier version
    event.frames = node["frames"].natural<int>();
    event.of_frames = node["of_frames"].natural<int>();
    event.steps = counts_in(node["steps"], SquareStep::in_square);
  }
  node["views"].each([&](const files::JsonNode& view) { event.views.push_back(view_of(view)); });
  return event;
}

std::vector<ScoredEvent> events_in(const files::JsonNode& document) {
  std::vector<ScoredEvent> events;
  document["events"].each([&](const files::JsonNode& event) { events.push_back(event_of(event)); });
  return events;
}

}  // namespace

files::Json json_of(const ScoredEvent& event) {
  files::Json json = {{"kind", text_of(event.kind).word}, {"first_frame", event.first_frame},
                      {"last_frame", event.last_frame},   {"object", event.object},
                      {"object_name", event.object_name}, {"corners", event.corners},
                      {"of", event.counted_corners},      {"radial", event.radial_corners},
                      {"circles", event.circles},         {"frames", event.frames},
                      {"of_frames", event.of_frames},     {"reasons", by_word(event.reasons)},
                      {"steps", by_word(event.steps)},    {"views", files::Json::array()}};
  for (const EventView& view : event.views) json["views"].push_back(json_of(view));
  return json;
}

void write_events(const std::filesystem::path& file, const std::vector<ScoredEvent>& events,
                  const EventSums& sums) {
  files::Json list = files::Json::array();
  for (const ScoredEvent& event : events) list.push_back(json_of(event));
  // A name may hold any bytes, but JSON must be UTF-8.
  const files::Json all{{"events", list},
                        {"sums",
                         {{"missed", by_word(sums.missed)},
                          {"false", by_word(sums.false_ones)},
                          {"squares", by_word(sums.squares)}}}};
  files::write_file(file, files::json_text(all, 1) + '\n');
}

std::vector<ScoredEvent> read_events(const std::filesystem::path& file) {
  return files::read_json(file, kEventsDocument, events_in);
}

EventSums read_event_sums(const std::filesystem::path& file) {
  return files::read_json(file, kEventsDocument, [](const files::JsonNode& node) {
    if (!node.has("sums")) return sums_of(events_in(node));
    const auto read = [&](const char* key, auto last) {
      const auto counts = counts_in(node["sums"][key], last);
      return std::map(counts.begin(), counts.end());
    };
    return EventSums{read("missed", kLastReason), read("false", kLastReason),
                     read("squares", EventKind::square_false)};
  });
}

std::string base64(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // with OpenSSL's zero at the end
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                  reinterpret_cast<const unsigned char*>(bytes.data()),
                  static_cast<int>(bytes.size()));
  text.pop_back();
  return text;
}

}  // namespace lcs::scoring
