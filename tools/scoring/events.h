/// \file
/// Where a run went wrong, worst first: rebels that were missed, static corners that were called
/// rebels, circles with no mover under them, objects without their square, squares without an
/// object, merged over neighbouring frames. What is missed and what is false is for
/// `score_rebels.h` and `score_squares.h` to say; here it is only gathered, with the reasons that
/// the detector gave.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::bench {

inline constexpr const char* kEventsFile = "events.json";

enum class EventKind : std::uint8_t {
  never_found,    ///< missed, an object that is never found
  found_late,     ///< missed before it is found
  lost,           ///< missed after it was found
  false_alarm,    ///< false rebels with no mover under them
  halo,           ///< false rebels round a mover
  circle_false,   ///< a rebel circle with no mover under it: a false object
  square_missed,  ///< an object that no square touches to speak of
  square_split,   ///< several squares on one object
  square_merged,  ///< one square over several objects
  square_size,    ///< an object whose square is too large, too small or aside
  square_false,   ///< a square on no object
};
/// What it is that went wrong; the worst are kept of each.
enum class EventFamily : std::uint8_t { rebels, circles, squares };
constexpr EventFamily family_of(EventKind kind) {
  return kind < EventKind::circle_false    ? EventFamily::rebels
         : kind == EventKind::circle_false ? EventFamily::circles
                                           : EventFamily::squares;
}

/// How far a corner of an object came on the way into a square.
enum class SquareStep : std::uint8_t {
  no_edge,    ///< no edge took it
  no_circle,  ///< its edge is in no circle
  no_square,  ///< its circle's centre is in no square
  in_square,  ///< it is in one
};

struct EventKindText {
  const char* word;     ///< in the file
  const char* meaning;  ///< for people
};
const EventKindText& text_of(EventKind kind);
const EventKindText& text_of(SquareStep step);

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
  /// Corners that recall counts on the object in these frames; 0 for false ones.
  int counted_corners = 0;
  int circles = 0;  ///< with no mover under them; what one of circles costs
  std::vector<std::pair<Reason, int>> reasons;  ///< of these corners, most frequent first
  std::vector<EventView> views;                 ///< up to five, in order
  /// \name Of squares, where `corners` is of all that the steps count, or that lie in a false one.
  ///@{
  int frames = 0;  ///< what it costs: frames in which it is so
  /// Frames meanwhile in which a square should have been there; 0 for false ones.
  int of_frames = 0;
  std::vector<std::pair<SquareStep, int>> steps;  ///< of an object's corners, most frequent first
  ///@}
};

/// How many of a family are worth pictures; and for who wants every one.
inline constexpr std::size_t kMostEvents = 5, kAllEvents = std::numeric_limits<std::size_t>::max();

/// The events of rebels, with the most corners first, then those of circles, with the most circles
/// first; at most `most` of each. \throws std::invalid_argument as `score`.
std::vector<Event> find_events(const Recording& recording, std::size_t most = kMostEvents);

/// The events of squares, with the most frames first; without steps from a detector that has no
/// edges.
/// \throws std::invalid_argument as `score`.
std::vector<Event> find_square_events(const Recording& recording, std::size_t most = kMostEvents);

/// Keeps the first `most` events of each family. \param events in the order of `find_events`.
void keep_worst(std::vector<Event>& events, std::size_t most);

/// What all events of a run cost, by what did it.
struct EventSums {
  std::map<Reason, int> missed, false_ones;  ///< corners, of events of rebels
  std::map<EventKind, int> squares;          ///< frames

  void add(const EventSums& other);
};
EventSums sums_of(const std::vector<Event>& events);

/// \param sums of all events of the run, of which these may be the worst. \throws OutputError
void write_events(const std::filesystem::path& file, const std::vector<Event>& events,
                  const EventSums& sums);

/// \throws std::runtime_error naming the file and what is wrong with it.
std::vector<Event> read_events(const std::filesystem::path& file);
/// The sums in a file of events; from a file of an earlier version, which has none, those of the
/// events in it. \throws as `read_events`.
EventSums read_event_sums(const std::filesystem::path& file);

std::string base64(std::string_view bytes);

}  // namespace lcs::bench
