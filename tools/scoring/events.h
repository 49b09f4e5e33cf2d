/// \file
/// The errors of a run, worst first: missed rebels, static corners with a rebel verdict, circles
/// with no mover under them, objects without their square, squares without an object. Errors in
/// neighbouring frames are merged into one event. `score_rebels.h` and `score_squares.h` define the
/// errors; events collect them with the detector's reasons.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/recording/recording.h"
#include "tools/scoring/scoring.h"

namespace lcs::scoring {

inline constexpr const char* kEventsFile = "events.json";

enum class EventKind : std::uint8_t {
  never_found,    ///< missed rebels of an object that is never found
  found_late,     ///< missed rebels before their object is found
  lost,           ///< missed rebels after their object was found
  false_alarm,    ///< false rebels with no mover under them
  halo,           ///< false rebels around a mover
  circle_false,   ///< a rebel circle with no mover under it: a false object
  square_missed,  ///< an object that no square overlaps notably
  square_split,   ///< several squares on one object
  square_merged,  ///< one square over several objects
  square_size,    ///< an object whose square is too large, too small or displaced
  square_false,   ///< a square on no object
};
/// Groups of event kinds. The worst events of each family are kept.
enum class EventFamily : std::uint8_t { rebels, circles, squares };
constexpr EventFamily family_of(EventKind kind) {
  return kind < EventKind::circle_false    ? EventFamily::rebels
         : kind == EventKind::circle_false ? EventFamily::circles
                                           : EventFamily::squares;
}

/// The last step that a corner of an object reached on the way into a square.
enum class SquareStep : std::uint8_t {
  no_edge,    ///< the corner has no edge
  no_circle,  ///< its edge is in no circle
  no_square,  ///< its circle's centre is in no square
  in_square,  ///< it is in a square
};

struct EventKindText {
  const char* word;     ///< in events.json
  const char* meaning;  ///< for the user
};
const EventKindText& text_of(EventKind kind);
const EventKindText& text_of(SquareStep step);

/// A frame and a region of its picture that illustrate an event.
struct EventView {
  int frame = 0;  ///< frame index
  double t_s = 0;
  /// The part of the image to show; with a picture the larger part that it shows.
  Vec2 centre_px = Vec2::Zero(), half_size_px = Vec2::Zero();
  std::string jpeg_base64;  ///< the annotated picture; empty: none
};

struct ScoredEvent {
  EventKind kind = EventKind::lost;
  int first_frame = 0, last_frame = 0;  ///< indices
  int object = 0;  ///< number of the missed object, or of the one with a halo; 0: none
  std::string object_name;
  int corners = 0;  ///< cost: number of missed or false corners
  /// The object's corners in these frames that recall counts; 0 for false rebels.
  int counted_corners = 0;
  int radial_corners = 0;  ///< the radial ones among `corners` (`sim::CornerTruth::radial`)
  int circles = 0;         ///< cost of a circle event: circles with no mover under them
  std::vector<std::pair<Reason, int>> reasons;  ///< with corner counts, most frequent first
  std::vector<EventView> views;                 ///< up to five, in order of time
  /// \name Square events. Their `corners` counts those in `steps`, or those in a false square.
  ///@{
  int frames = 0;  ///< cost: number of frames with the error
  /// Frames of the event in which a square should have been there; 0 for false squares.
  int of_frames = 0;
  std::vector<std::pair<SquareStep, int>> steps;  ///< with corner counts, most frequent first
  ///@}
};

/// The events of a family that a run keeps.
inline constexpr std::size_t kMostEvents = 5;

/// Finds the events of a run frame by frame, in order. It keeps some 100 bytes for each error, and
/// nothing of a frame without errors.
class EventFinder {
 public:
  /// Uses the run's detector, truth and names of objects.
  explicit EventFinder(const recording::RunInfo& run);
  ~EventFinder();
  EventFinder(EventFinder&&) noexcept;

  /// \param outcomes of the frame's corners.
  void add(const recording::FrameRecord& frame, const std::vector<CornerOutcome>& outcomes);

  /// The rebel events, most corners first, then the circle events, most circles first, then the
  /// square events, most frames first. Square events have no steps if the detector has no edges.
  /// \param detections of the whole run (`Scorer::detections`).
  std::vector<ScoredEvent> events(const std::map<int, ObjectDetection>& detections) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Keeps the first `most` events of each family. \param events in the order of `EventFinder`.
void keep_worst(std::vector<ScoredEvent>& events, std::size_t most);

/// The total costs of all events of a run, by cause.
struct EventSums {
  std::map<Reason, int> missed, false_ones;  ///< corners of rebel events
  std::map<EventKind, int> squares;          ///< frames of square events

  void add(const EventSums& other);
};
EventSums sums_of(const std::vector<ScoredEvent>& events);

/// As in events.json.
nlohmann::ordered_json json_of(const ScoredEvent& event);

/// \param sums over all events of the run; `events` may be only the worst. \throws OutputError
void write_events(const std::filesystem::path& file, const std::vector<ScoredEvent>& events,
                  const EventSums& sums);

/// \throws std::runtime_error that names the file and the fault.
std::vector<ScoredEvent> read_events(const std::filesystem::path& file);
/// The sums in a file of events. A file of an earlier version has none; its events are summed.
/// \throws as `read_events`.
EventSums read_event_sums(const std::filesystem::path& file);

std::string base64(std::string_view bytes);

}  // namespace lcs::scoring
