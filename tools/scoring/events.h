/// \file
/// Where a run went wrong, worst first: rebels that were missed, and static corners that were
/// called rebels, merged over neighbouring frames. What is missed and what is false is for
/// `score_rebels.h` to say; here it is only gathered, with the reasons that the tracker gave.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::bench {

inline constexpr const char* kEventsFile = "events.json";

enum class EventKind : std::uint8_t {
  never_found,  ///< missed, an object that is never found
  found_late,   ///< missed before it is found
  lost,         ///< missed after it was found
  false_alarm,  ///< false rebels with no mover under them
  halo,         ///< false rebels round a mover
};

struct EventKindText {
  const char* word;     ///< in the file
  const char* meaning;  ///< for people
};
const EventKindText& text_of(EventKind kind);

/// A frame to be looked at, and where.
struct EventView {
  int frame = 0;  ///< its index
  double t_s = 0;
  Vec2 centre_px = Vec2::Zero();
  Vec2 half_size_px = Vec2::Zero();
  std::string jpeg_base64;  ///< the annotated picture; empty: none was made
};

struct Event {
  EventKind kind = EventKind::lost;
  int first_frame = 0, last_frame = 0;  ///< indices
  int object = 0;                       ///< missed, or with a halo; 0: none
  std::string object_name;
  int corners = 0;  ///< what it costs: corners missed, or false
  int of = 0;       ///< corners that recall counts on the object in these frames; 0 for false ones
  int circles = 0;  ///< rebel circles with no mover under them
  std::vector<std::pair<Reason, int>> reasons;  ///< of these corners, most frequent first
  std::vector<EventView> views;                 ///< up to five, in order
};

/// At most `most` events, those with the most corners first.
/// \throws std::invalid_argument as `score`.
std::vector<Event> find_events(const Recording& recording, std::size_t most = 5);

/// \throws OutputError
void write_events(const std::filesystem::path& file, const std::vector<Event>& events);

/// \throws std::runtime_error naming the file and what is wrong with it.
std::vector<Event> read_events(const std::filesystem::path& file);

std::string base64(std::string_view bytes);

}  // namespace lcs::bench
