#include "tools/scoring/events.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "tools/recording/box.h"
#include "tools/scoring/score_rebels.h"
#include "tools/scoring/score_squares.h"

namespace lcs::bench {
namespace {

/// Most consecutive frames without an error within one event.
constexpr int kGap = 2;
/// False corners closer than this form a group. Groups of fewer than `kCornersToFind` are dropped.
constexpr double kGroupReach_px = 40;
/// Largest distance between a group's boxes in successive frames.
constexpr double kTrackReach_px = 20;
constexpr int kViews = 5;

/// A square and an object with a smaller IoU are unrelated.
constexpr double kLeastIou = 0.1;
/// A square or an object with more than this share of its area in the other counts as inside it.
constexpr double kMostOfIt = 0.5;
/// Least number of frames of a square event.
constexpr int kLeastFrames = 3;

constexpr std::array<EventKindText, 11> kKinds{{
    {"never_found", "never found"},
    {"found_late", "found late"},
    {"lost", "lost"},
    {"false_alarm", "false alarm"},
    {"halo", "static corners round it called rebels"},
    {"circle_false", "a false object"},
    {"square_missed", "no square on it"},
    {"square_split", "several squares on it"},
    {"square_merged", "in one square with others"},
    {"square_size", "its square is of another size or place"},
    {"square_false", "a square on no object"},
}};

constexpr std::array<EventKindText, 4> kSteps{{
    {"no_edge", "corners that no edge took"},
    {"no_circle", "edges in no circle: too few of like motion beside them"},
    {"no_square", "edges whose circle is in no square"},
    {"in_square", "edges in a square"},
}};

using Outcomes = std::vector<std::vector<CornerOutcome>>;

/// The part of an event in one frame.
struct Part {
  std::vector<std::size_t> corners;  // the missed or false ones
  int counted_corners = 0;
  int circles = 0;
  Box box;
  bool is_of_squares = false;  // whether it is an error of squares
};

/// Parts by the frame's position in the recording.
using Parts = std::map<std::size_t, Part>;

/// The object's box in pixel centres, both ends included.
std::optional<Box> box_in(const FrameRecord& frame, int object) {
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    if (truth.object == object) {
      return Box{Vec2(truth.left, truth.top), Vec2(truth.right - 1, truth.bottom - 1)};
    }
  }
  return std::nullopt;
}

Box box_round(const FrameRecord& frame, const std::vector<std::size_t>& corners) {
  Box box;
  for (const std::size_t i : corners) box.extend(frame.corners_px[i].cast<double>());
  return box;
}

std::vector<std::pair<Reason, int>> reasons_of(const Recording& recording, const Parts& parts) {
  std::map<Reason, int> counts;
  for (const auto& [position, part] : parts) {
    const FrameRecord& frame = recording.frames[position];
    for (const std::size_t i : part.corners) {
      ++counts[frame.reasons.empty() ? Reason::unknown : frame.reasons.at(i)];
    }
  }
  std::vector<std::pair<Reason, int>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

EventView view_of(const FrameRecord& frame, const Box& box) {
  return {.frame = frame.index,
          .t_s = static_cast<double>(frame.t_ns) * 1e-9,
          .centre_px = box.center(),
          .half_size_px = 0.5 * box.sizes(),
          .jpeg_base64 = ""};
}

/// Evenly spaced frames of the event, preceded and followed by one frame outside it.
std::vector<EventView> views_of(const Recording& recording, const Event& event,
                                const Parts& parts) {
  std::vector<EventView> all;
  const auto aside = [&](std::size_t position, const Box& box) {
    const FrameRecord& frame = recording.frames[position];
    if (event.object == 0) all.push_back(view_of(frame, box));
    if (const auto now = box_in(frame, event.object)) all.push_back(view_of(frame, *now));
  };
  const auto& [first, first_part] = *parts.begin();
  const auto& [last, last_part] = *parts.rbegin();
  if (first > 0) aside(first - 1, first_part.box);
  for (const auto& [position, part] : parts) {
    if (part.corners.empty() && part.circles == 0 && !part.is_of_squares) continue;
    all.push_back(view_of(recording.frames[position], part.box));
  }
  if (last + 1 < recording.frames.size()) aside(last + 1, last_part.box);

  if (all.size() <= kViews) return all;
  std::vector<EventView> some;
  for (int i = 0; i < kViews; ++i) {
    const double at = static_cast<double>(all.size() - 1) * i / (kViews - 1);
    some.push_back(all[static_cast<std::size_t>(std::lround(at))]);
  }
  return some;
}

Event event_of(const Recording& recording, EventKind kind, int object, const Parts& parts) {
  Event event;
  event.kind = kind;
  event.object = object;
  for (const sim::Object& named : recording.objects) {
    if (named.id == object) event.object_name = named.name;
  }
  event.first_frame = recording.frames[parts.begin()->first].index;
  event.last_frame = recording.frames[parts.rbegin()->first].index;
  for (const auto& [position, part] : parts) {
    event.corners += static_cast<int>(part.corners.size());
    event.counted_corners += part.counted_corners;
    event.circles += part.circles;
    const auto& truth = recording.frames[position].corner_truth;
    event.radial_corners += static_cast<int>(std::ranges::count_if(
        part.corners, [&](std::size_t corner) { return truth[corner].radial; }));
  }
  event.reasons = reasons_of(recording, parts);
  event.views = views_of(recording, event, parts);
  return event;
}

/// Splits the parts where more than `kGap` frames pass without a part that `is_bad`. Good parts
/// between bad ones are kept.
template <class IsBad>
std::vector<Parts> runs_of(const Parts& parts, IsBad&& is_bad) {
  std::vector<Parts> runs;
  Parts between;
  std::optional<std::size_t> last;
  for (const auto& [position, part] : parts) {
    if (!is_bad(part)) {
      between.emplace(position, part);
      continue;
    }
    if (!last || position - *last > kGap + 1) {
      runs.emplace_back();
    } else {
      runs.back().merge(between);
    }
    between.clear();
    runs.back().emplace(position, part);
    last = position;
  }
  return runs;
}

int corners_of(const Parts& parts) {
  return std::accumulate(parts.begin(), parts.end(), 0, [](int sum, const auto& entry) {
    return sum + static_cast<int>(entry.second.corners.size());
  });
}

// ---- Missed

/// The rebel corners of an object that recall counts, by frame.
Parts counted_corners(const Recording& recording, const Outcomes& outcomes, int object) {
  Parts parts;
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    const FrameRecord& frame = recording.frames[k];
    Part part;
    for (std::size_t i = 0; i < outcomes[k].size(); ++i) {
      if (frame.corner_truth[i].object != object) continue;
      const bool missed = outcomes[k][i] == CornerOutcome::missed;
      if (missed) part.corners.push_back(i);
      part.counted_corners += missed || outcomes[k][i] == CornerOutcome::found;
    }
    if (part.counted_corners == 0) continue;
    if (const auto box = box_in(frame, object)) {
      part.box = *box;
    } else if (!part.corners.empty()) {
      part.box = box_round(frame, part.corners);
    }
    parts.emplace(k, std::move(part));
  }
  return parts;
}

void find_missed(const Recording& recording, const Outcomes& outcomes, std::vector<Event>& events) {
  for (const ObjectDetection& object : detect_objects(recording)) {
    const Parts counted = counted_corners(recording, outcomes, object.object);
    const auto mostly_missed = [](const Part& part) {
      return 2 * static_cast<int>(part.corners.size()) > part.counted_corners;
    };
    for (const Parts& run : runs_of(counted, mostly_missed)) {
      if (corners_of(run) < kCornersToFind) continue;
      const int first = recording.frames[run.begin()->first].index;
      const EventKind kind = !object.found_at           ? EventKind::never_found
                             : *object.found_at > first ? EventKind::found_late
                                                        : EventKind::lost;
      events.push_back(event_of(recording, kind, object.object, run));
    }
  }
}

// ---- False

/// Groups these corners of a frame: neighbours closer than `kGroupReach_px` share a group.
std::vector<std::vector<std::size_t>> groups_of(const FrameRecord& frame,
                                                std::vector<std::size_t> corners) {
  std::vector<std::vector<std::size_t>> groups;
  while (!corners.empty()) {
    std::vector<std::size_t> group{corners.back()};
    corners.pop_back();
    for (std::size_t next = 0; next < group.size(); ++next) {
      const Eigen::Vector2f x = frame.corners_px[group[next]];
      const auto near =
          std::stable_partition(corners.begin(), corners.end(), [&](std::size_t other) {
            return static_cast<double>((frame.corners_px[other] - x).norm()) > kGroupReach_px;
          });
      group.insert(group.end(), near, corners.end());
      corners.erase(near, corners.end());
    }
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

/// The number of the moving object with the nearest box; 0 if nothing moves.
int nearest_mover(const FrameRecord& frame, const Box& box) {
  int nearest = 0;
  double least = 0;
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    if (!truth.moving) continue;
    const double d = box_in(frame, truth.object)->exteriorDistance(box);
    if (nearest == 0 || d < least) std::tie(nearest, least) = std::tuple(truth.object, d);
  }
  return nearest;
}

/// A group of false rebels, tracked through the frames.
struct Track {
  Parts parts;
  const Box& box() const { return parts.rbegin()->second.box; }
};

class FalseGroups {
 public:
  explicit FalseGroups(const Recording& recording) : recording_(recording) {}

  void add_frame(std::size_t position, const std::vector<CornerOutcome>& outcomes) {
    const FrameRecord& frame = recording_.frames[position];
    std::vector<std::size_t> corners;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i] == CornerOutcome::false_rebel) corners.push_back(i);
    }
    for (const Circle* circle : false_circles(frame)) {
      Part part;
      part.circles = 1;
      const Vec2 reach(circle->radius, circle->radius);
      part.box = {circle->location - reach, circle->location + reach};
      std::erase_if(corners, [&](std::size_t i) {
        const Vec2 x = frame.corners_px[i].cast<double>();
        if ((x - circle->location).norm() > circle->radius) return false;
        part.corners.push_back(i);
        return true;
      });
      follow(position, std::move(part));
    }
    for (std::vector<std::size_t>& group : groups_of(frame, std::move(corners))) {
      if (group.size() < kCornersToFind) continue;
      Part part;
      part.box = box_round(frame, group);
      part.corners = std::move(group);
      const Vec2 half = 0.5 * part.box.sizes();
      if (has_mover_under(frame, part.box.center(), half.norm())) {
        Part& halo = halos_[nearest_mover(frame, part.box)][position];
        halo.corners.insert(halo.corners.end(), part.corners.begin(), part.corners.end());
      } else {
        follow(position, std::move(part));
      }
    }
  }

  void finish(std::vector<Event>& events) {
    for (const Track& track : tracks_) {
      Event event = event_of(recording_, EventKind::false_alarm, 0, track.parts);
      if (event.circles > 0) event.kind = EventKind::circle_false;
      events.push_back(std::move(event));
    }
    for (auto& [object, parts] : halos_) {
      for (auto& [position, part] : parts) {
        const FrameRecord& frame = recording_.frames[position];
        part.box = box_round(frame, part.corners);
        if (const auto box = box_in(frame, object)) part.box.extend(*box);
      }
      for (const Parts& run : runs_of(parts, [](const Part&) { return true; })) {
        events.push_back(event_of(recording_, EventKind::halo, object, run));
      }
    }
  }

 private:
  /// Appends a part to the nearest recent track, or to a new one.
  void follow(std::size_t position, Part part) {
    Track* nearest = nullptr;
    for (Track& track : tracks_) {
      const std::size_t last = track.parts.rbegin()->first;
      if (position - last > kGap + 1) continue;
      const double d = track.box().exteriorDistance(part.box);
      if (d > kTrackReach_px) continue;
      if (!nearest || d < nearest->box().exteriorDistance(part.box)) nearest = &track;
    }
    if (!nearest) nearest = &tracks_.emplace_back();
    const auto [entry, is_new] = nearest->parts.try_emplace(position, part);
    if (is_new) return;
    Part& before = entry->second;
    before.corners.insert(before.corners.end(), part.corners.begin(), part.corners.end());
    before.circles += part.circles;
    before.box.extend(part.box);
  }

  const Recording& recording_;
  std::vector<Track> tracks_;
  std::map<int, Parts> halos_;  // by object
};

// ---- Squares

/// The reason that an eligible object has no right square.
EventKind cause_of(const FrameRecord& frame, const std::set<int>& eligible,
                   const sim::ObjectTruth& object) {
  const Box own = box_of(object);
  int pieces = 0;
  double best_iou = 0;
  bool is_merged = false;
  for (const Square& square : frame.layers.squares) {
    const Box box = box_of(square);
    const double common = common_px2(own, box);
    best_iou = std::max(best_iou, intersection_over_union(own, box));
    pieces += common > kMostOfIt * box.volume();
    if (common <= kMostOfIt * own.volume()) continue;
    is_merged |= std::ranges::any_of(frame.object_truth, [&](const sim::ObjectTruth& other) {
      return other.object != object.object && eligible.contains(other.object) &&
             common_px2(box_of(other), box) > kMostOfIt * box_of(other).volume();
    });
  }
  return pieces > 1             ? EventKind::square_split
         : is_merged            ? EventKind::square_merged
         : best_iou < kLeastIou ? EventKind::square_missed
                                : EventKind::square_size;
}

std::map<SquareStep, int> steps_of(const FrameRecord& frame, int object) {
  std::map<SquareStep, int> steps;
  std::map<int, const Edge*> edges;  // by corner
  for (const auto* kind : {&frame.layers.normal_edges, &frame.layers.rebel_edges}) {
    for (const Edge& edge : *kind) edges[edge.corner] = &edge;
  }
  const auto step = [&](std::size_t corner) {
    const auto found = edges.find(static_cast<int>(corner));
    if (found == edges.end()) return SquareStep::no_edge;
    const Edge& edge = *found->second;
    const auto& circles = edge.rebel ? frame.layers.rebel_circles : frame.layers.normal_circles;
    if (edge.circle < 0 || edge.circle >= std::ssize(circles)) return SquareStep::no_circle;
    const Vec2 centre = circles[static_cast<std::size_t>(edge.circle)].location;
    const bool is_in = std::ranges::any_of(frame.layers.squares, [&](const Square& square) {
      return box_of(square).contains(centre);
    });
    return is_in ? SquareStep::in_square : SquareStep::no_square;
  };
  for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
    if (frame.corner_truth[i].object == object) ++steps[step(i)];
  }
  return steps;
}

class SquareEvents {
 public:
  explicit SquareEvents(const Recording& recording) : recording_(recording) {}

  void add_frame(std::size_t position) {
    const FrameRecord& frame = recording_.frames[position];
    const SquareOutcomes outcomes = square_outcomes(frame);
    std::set<Id> wrong(outcomes.wrong.begin(), outcomes.wrong.end());
    for (const sim::ObjectTruth& object : frame.object_truth) {
      if (!outcomes.eligible.contains(object.object)) continue;
      const bool found =
          std::ranges::find(outcomes.right, object.object, &BoxPair::box) != outcomes.right.end();
      // an object with a right square may have further, false ones
      const bool is_doubled =
          found && std::ranges::any_of(frame.layers.squares, [&](auto& square) {
            return wrong.contains(square.id) &&
                   common_px2(box_of(square), box_of(object)) > kMostOfIt * box_of(square).volume();
          });
      Part part;
      part.counted_corners = 1;
      part.box = *box_in(frame, object.object);
      part.is_of_squares = !found || is_doubled;
      if (part.is_of_squares) {
        causes_[{object.object, position}] =
            is_doubled ? EventKind::square_split : cause_of(frame, outcomes.eligible, object);
      }
      objects_[object.object].emplace(position, part);
    }
    for (const Square& square : frame.layers.squares) {
      const bool touches = std::ranges::any_of(frame.object_truth, [&](const auto& object) {
        return intersection_over_union(box_of(object), box_of(square)) >= kLeastIou ||
               common_px2(box_of(object), box_of(square)) > kMostOfIt * box_of(square).volume();
      });
      if (touches || !wrong.contains(square.id)) continue;
      Part part;
      part.box = box_of(square);
      part.is_of_squares = true;
      for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
        if (part.box.contains(frame.corners_px[i].cast<double>())) part.corners.push_back(i);
      }
      false_[square.id].emplace(position, part);
    }
  }

  std::vector<Event> events() const {
    std::vector<Event> all;
    const auto is_wrong = [](const Part& part) { return part.is_of_squares; };
    for (const auto& [object, parts] : objects_) {
      for (const Parts& run : runs_of(parts, is_wrong)) add_missed(object, run, all);
    }
    for (const auto& [square, parts] : false_) {
      for (const Parts& run : runs_of(parts, is_wrong)) {
        if (std::ssize(run) < kLeastFrames) continue;
        Event event = event_of(recording_, EventKind::square_false, 0, run);
        event.frames = static_cast<int>(run.size());
        all.push_back(std::move(event));
      }
    }
    return all;
  }

 private:
  void add_missed(int object, const Parts& run, std::vector<Event>& all) const {
    std::map<EventKind, int> kinds;
    std::map<SquareStep, int> steps;
    int frames = 0;
    for (const auto& [position, part] : run) {
      if (!part.is_of_squares) continue;
      ++frames;
      ++kinds[causes_.at({object, position})];
      if (!recording_.detector.layered) continue;
      for (const auto& [step, corners] : steps_of(recording_.frames[position], object)) {
        steps[step] += corners;
      }
    }
    if (frames < kLeastFrames) return;
    const auto most =
        std::ranges::max_element(kinds, {}, [](const auto& kind) { return kind.second; });
    Event event = event_of(recording_, most->first, object, run);
    event.counted_corners = 0;  // applies to rebel events only
    event.frames = frames;
    event.of_frames = static_cast<int>(run.size());
    event.reasons.clear();
    event.steps.assign(steps.begin(), steps.end());
    std::ranges::stable_sort(event.steps, std::greater(), &std::pair<SquareStep, int>::second);
    for (const auto& [step, corners] : event.steps) event.corners += corners;
    all.push_back(std::move(event));
  }

  const Recording& recording_;
  std::map<int, Parts> objects_;  // frames in which a square should be there
  std::map<std::pair<int, std::size_t>, EventKind> causes_;
  std::map<Id, Parts> false_;
};

}  // namespace

const EventKindText& text_of(EventKind kind) {
  return kKinds[static_cast<std::size_t>(kind)];
}

const EventKindText& text_of(SquareStep step) {
  return kSteps[static_cast<std::size_t>(step)];
}

EventSums sums_of(const std::vector<Event>& events) {
  EventSums sums;
  for (const Event& event : events) {
    if (family_of(event.kind) == EventFamily::squares) {
      sums.squares[event.kind] += event.frames;
      continue;
    }
    for (const auto& [reason, corners] : event.reasons) {
      (event.counted_corners > 0 ? sums.missed : sums.false_ones)[reason] += corners;
    }
  }
  return sums;
}

void EventSums::add(const EventSums& other) {
  const auto add = [](auto& to, const auto& from) {
    for (const auto& [cause, count] : from) to[cause] += count;
  };
  add(missed, other.missed);
  add(false_ones, other.false_ones);
  add(squares, other.squares);
}

std::vector<Event> find_square_events(const Recording& recording, std::size_t most) {
  if (recording.truth != Truth::all) return {};  // the objects are unknown
  SquareEvents squares(recording);
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    if (recording.frames[k].index >= kSightings) squares.add_frame(k);
  }
  std::vector<Event> events = squares.events();
  std::ranges::stable_sort(events, std::greater(), &Event::frames);
  keep_worst(events, most);
  return events;
}

std::vector<Event> find_events(const Recording& recording, std::size_t most) {
  if (recording.truth == Truth::unknown) return {};  // errors are undefined without truth
  const Outcomes outcomes = corner_outcomes(recording);
  std::vector<Event> events;
  find_missed(recording, outcomes, events);
  FalseGroups groups(recording);
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    if (recording.frames[k].index >= kSightings) groups.add_frame(k, outcomes[k]);
  }
  groups.finish(events);
  const auto rank = [](const Event& event) {  // rebel events have no circles
    return std::tuple(family_of(event.kind), -event.circles, -event.corners);
  };
  std::ranges::stable_sort(events, {}, rank);
  keep_worst(events, most);
  return events;
}

void keep_worst(std::vector<Event>& events, std::size_t most) {
  std::map<EventFamily, std::size_t> kept;
  std::erase_if(events, [&](const Event& event) { return kept[family_of(event.kind)]++ >= most; });
}

}  // namespace lcs::bench
