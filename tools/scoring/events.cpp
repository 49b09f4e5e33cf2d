#include "tools/scoring/events.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <tuple>

#include "tools/recording/box.h"
#include "tools/scoring/score_rebels.h"
#include "tools/scoring/score_squares.h"

namespace lcs::scoring {
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

/// The part of an event in one frame, or the sum of several.
struct Part {
  int corners = 0;  // the missed or false ones
  int radial_corners = 0, counted_corners = 0, circles = 0;
  std::map<Reason, int> reasons;
  recording::Box box;
  std::optional<EventKind> cause;   // of a fault of squares
  std::map<SquareStep, int> steps;  // of its object's corners

  bool is_error() const { return corners > 0 || circles > 0 || cause; }
};

template <class Counts>
void add_to(Counts& sum, const Counts& counts) {
  for (const auto& [key, count] : counts) sum[key] += count;
}

void add_to(Part& sum, const Part& part) {
  sum.corners += part.corners;
  sum.radial_corners += part.radial_corners;
  sum.counted_corners += part.counted_corners;
  sum.circles += part.circles;
  add_to(sum.reasons, part.reasons);
  add_to(sum.steps, part.steps);
}

void add_corner(const recording::FrameRecord& frame, std::size_t i, Part& part) {
  ++part.corners;
  part.radial_corners += frame.corner_truth[i].radial;
  ++part.reasons[frame.reasons.empty() ? Reason::unknown : frame.reasons.at(i)];
}

/// The counts, largest first.
template <class Cause>
std::vector<std::pair<Cause, int>> by_count(const std::map<Cause, int>& counts) {
  std::vector<std::pair<Cause, int>> sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, std::greater(), &std::pair<Cause, int>::second);
  return sorted;
}

/// Boxes by object, in pixel centres, both ends included.
using Boxes = std::map<int, recording::Box>;

/// All of a frame that the views of events show.
struct Moment {
  std::size_t position = 0;  // in the run
  int frame = 0;
  std::int64_t t_ns = 0;
  Boxes boxes;

  Moment(std::size_t place, const recording::FrameRecord& record)
      : position(place), frame(record.index), t_ns(record.t_ns) {
    for (const sim::ObjectTruth& truth : record.object_truth) {
      boxes.try_emplace(truth.object, Vec2(truth.left, truth.top),
                        Vec2(truth.right - 1, truth.bottom - 1));
    }
  }

  EventView view(const recording::Box& box) const {
    return {.frame = frame,
            .t_s = static_cast<double>(t_ns) * 1e-9,
            .centre_px = box.center(),
            .half_size_px = 0.5 * box.sizes(),
            .jpeg_base64 = ""};
  }
};

/// The last frame, and the one before it.
struct Moments {
  std::optional<Moment> before, now;
};

/// An event as it grows.
struct Run {
  int first_frame = 0, last_frame = 0;
  std::size_t last = 0;  // position
  int frames = 0;        // of which each has a part
  Part sum;
  recording::Box last_box;
  std::map<EventKind, int> causes;      // frames with an error of squares
  std::vector<EventView> views;         // of the frame before the event, then of its errors
  std::optional<EventView> view_after;  // of the frame after the event

  void add(const Part& part, const Moment& now) {
    if (part.is_error()) views.push_back(now.view(part.box));
    if (part.cause) ++causes[*part.cause];
    add_to(sum, part);
    last_box = part.box;
    last = now.position;
    last_frame = now.frame;
    ++frames;
    view_after.reset();
  }
};

/// Up to `kViews` of the views, evenly spaced.
std::vector<EventView> some_of(const std::vector<EventView>& all) {
  if (all.size() <= kViews) return all;
  std::vector<EventView> some;
  for (int i = 0; i < kViews; ++i) {
    const double at = static_cast<double>(all.size() - 1) * i / (kViews - 1);
    some.push_back(all[static_cast<std::size_t>(std::lround(at))]);
  }
  return some;
}

/// The errors of one object, one square or one group of corners: a new run begins where more than
/// `kGap` frames pass without an error.
class Errors {
 public:
  /// \param object 0: none, the views show the place.
  explicit Errors(int object) : object_(object) {}

  /// \param is_bad the part is an error; other parts count if they lie between errors of a run.
  void add(const Part& part, bool is_bad, const Moments& moments) {
    const Moment& now = *moments.now;
    const bool goes_on = !runs_.empty() && now.position - runs_.back().last <= kGap + 1;
    if (!goes_on) between_.clear();
    if (!is_bad) {
      if (goes_on) between_.emplace_back(part, now);
      return;
    }
    if (!goes_on) {
      Run& run = runs_.emplace_back();
      run.first_frame = now.frame;
      if (moments.before) {
        if (const auto view = beside(*moments.before, part.box)) run.views.push_back(*view);
      }
    }
    for (const auto& [other, moment] : between_) runs_.back().add(other, moment);
    between_.clear();
    runs_.back().add(part, now);
  }

  /// Takes the view after the last error. To be called once for each frame.
  void look(const Moment& now) {
    if (runs_.empty() || runs_.back().last + 1 != now.position) return;
    runs_.back().view_after = beside(now, runs_.back().last_box);
  }

  const std::vector<Run>& runs() const { return runs_; }

  ScoredEvent event(EventKind kind, const Run& run, const recording::RunInfo& of) const {
    ScoredEvent event;
    event.kind = kind;
    event.object = object_;
    for (const sim::Object& named : of.objects) {
      if (named.id == object_) event.object_name = named.name;
    }
    event.first_frame = run.first_frame;
    event.last_frame = run.last_frame;
    event.corners = run.sum.corners;
    event.radial_corners = run.sum.radial_corners;
    event.counted_corners = run.sum.counted_corners;
    event.circles = run.sum.circles;
    event.reasons = by_count(run.sum.reasons);
    std::vector<EventView> views = run.views;
    if (run.view_after) views.push_back(*run.view_after);
    event.views = some_of(views);
    return event;
  }

 private:
  /// The view of a frame beside the run; absent if the object is not in it.
  std::optional<EventView> beside(const Moment& moment, const recording::Box& box) const {
    if (object_ == 0) return moment.view(box);
    const auto own = moment.boxes.find(object_);
    return own == moment.boxes.end() ? std::nullopt : std::optional(moment.view(own->second));
  }

  int object_;
  std::vector<Run> runs_;
  std::vector<std::pair<Part, Moment>> between_;  // since the last error
};

using ErrorsByObject = std::map<int, Errors>;

Errors& errors_of(ErrorsByObject& all, int object) {
  return all.try_emplace(object, object).first->second;
}

// ---- Missed

/// The rebel corners of each object that recall counts.
std::map<int, Part> missed_parts(const recording::FrameRecord& frame,
                                 const std::vector<CornerOutcome>& outcomes, const Boxes& boxes) {
  std::map<int, Part> parts;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const bool missed = outcomes[i] == CornerOutcome::missed;
    if (!missed && outcomes[i] != CornerOutcome::found) continue;
    Part& part = parts[frame.corner_truth[i].object];
    ++part.counted_corners;
    if (!missed) continue;
    add_corner(frame, i, part);
    part.box.extend(frame.corners_px[i].cast<double>());
  }
  for (auto& [object, part] : parts) {
    if (const auto own = boxes.find(object); own != boxes.end()) part.box = own->second;
  }
  return parts;
}

// ---- False

/// Groups these corners of a frame: neighbours closer than `kGroupReach_px` share a group.
std::vector<std::vector<std::size_t>> groups_of(const recording::FrameRecord& frame,
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
    std::ranges::sort(group);
    groups.push_back(std::move(group));
  }
  return groups;
}

/// The number of the moving object with the nearest box; 0 if nothing moves.
int nearest_mover(const recording::FrameRecord& frame, const Boxes& boxes,
                  const recording::Box& box) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const auto nearest =
      std::ranges::min_element(frame.object_truth, {}, [&](const sim::ObjectTruth& truth) {
        return truth.moving ? boxes.at(truth.object).exteriorDistance(box) : kFar;
      });
  return nearest != frame.object_truth.end() && nearest->moving ? nearest->object : 0;
}

/// Groups of false rebels and false circles, tracked through the frames.
class FalseGroups {
 public:
  void add_frame(const recording::FrameRecord& frame, const std::vector<CornerOutcome>& outcomes,
                 const Moments& moments) {
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
        add_corner(frame, i, part);
        return true;
      });
      follow(moments.now->position, part);
    }
    const Boxes& boxes = moments.now->boxes;
    std::map<int, Part> halos;
    for (const std::vector<std::size_t>& group : groups_of(frame, std::move(corners))) {
      if (group.size() < kCornersToFind) continue;
      Part part;
      for (const std::size_t i : group) {
        add_corner(frame, i, part);
        part.box.extend(frame.corners_px[i].cast<double>());
      }
      const Vec2 half = 0.5 * part.box.sizes();
      if (has_mover_under(frame, part.box.center(), half.norm())) {
        merge(part, halos[nearest_mover(frame, boxes, part.box)]);
      } else {
        follow(moments.now->position, part);
      }
    }
    for (auto& [object, halo] : halos) {
      if (const auto own = boxes.find(object); own != boxes.end()) halo.box.extend(own->second);
      errors_of(halos_, object).add(halo, true, moments);
    }
    for (Track& track : tracks_) {
      if (track.last == moments.now->position) track.errors.add(track.part, true, moments);
    }
  }

  void look(const Moment& now) {
    for (Track& track : tracks_) track.errors.look(now);
    for (auto& [object, errors] : halos_) errors.look(now);
  }

  void add_to(std::vector<ScoredEvent>& events, const recording::RunInfo& of) const {
    for (const Track& track : tracks_) {
      ScoredEvent event =
          track.errors.event(EventKind::false_alarm, track.errors.runs().front(), of);
      if (event.circles > 0) event.kind = EventKind::circle_false;
      events.push_back(std::move(event));
    }
    for (const auto& [object, errors] : halos_) {
      for (const Run& run : errors.runs()) {
        events.push_back(errors.event(EventKind::halo, run, of));
      }
    }
  }

 private:
  struct Track {
    std::size_t last = 0;  // position
    Part part = {};        // in that frame
    Errors errors{0};
  };

  static void merge(const Part& part, Part& sum) {
    scoring::add_to(sum, part);
    sum.box.extend(part.box);
  }

  /// Appends a part to the nearest recent track, or to a new one.
  void follow(std::size_t position, const Part& part) {
    Track* nearest = nullptr;
    for (Track& track : tracks_) {
      if (position - track.last > kGap + 1) continue;
      const double d = track.part.box.exteriorDistance(part.box);
      if (d > kTrackReach_px) continue;
      if (!nearest || d < nearest->part.box.exteriorDistance(part.box)) nearest = &track;
    }
    if (!nearest) nearest = &tracks_.emplace_back();
    if (nearest->last == position && nearest->part.is_error()) {
      merge(part, nearest->part);
    } else {
      nearest->part = part;
    }
    nearest->last = position;
  }

  std::vector<Track> tracks_;
  ErrorsByObject halos_;
};

// ---- Squares

/// Whether the square or object has more than `kMostOfIt` of its area in the other.
bool is_mostly_in(const auto& one, const auto& other) {
  const recording::Box box = recording::box_of(one);
  return recording::common_px2(box, recording::box_of(other)) > kMostOfIt * box.volume();
}

/// The reason that an eligible object has no right square.
EventKind cause_of(const recording::FrameRecord& frame, const std::set<int>& eligible,
                   const sim::ObjectTruth& object) {
  int pieces = 0;
  double best_iou = 0;
  bool is_merged = false;
  for (const Square& square : frame.layers.squares) {
    best_iou = std::max(best_iou, iou_of(object, square));
    pieces += is_mostly_in(square, object);
    if (!is_mostly_in(object, square)) continue;
    is_merged |= std::ranges::any_of(frame.object_truth, [&](const sim::ObjectTruth& other) {
      return other.object != object.object && eligible.contains(other.object) &&
             is_mostly_in(other, square);
    });
  }
  return pieces > 1             ? EventKind::square_split
         : is_merged            ? EventKind::square_merged
         : best_iou < kLeastIou ? EventKind::square_missed
                                : EventKind::square_size;
}

std::map<SquareStep, int> steps_of(const recording::FrameRecord& frame, int object) {
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
      return recording::box_of(square).contains(centre);
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
  void add_frame(const recording::FrameRecord& frame, bool is_layered, const Moments& moments) {
    const SquareOutcomes outcomes = square_outcomes(frame);
    const std::set<Id> wrong(outcomes.wrong.begin(), outcomes.wrong.end());
    for (const sim::ObjectTruth& object : frame.object_truth) {
      if (!outcomes.eligible.contains(object.object)) continue;
      const bool found =
          std::ranges::find(outcomes.right, object.object, &BoxPair::box) != outcomes.right.end();
      // an object with a right square may have further, false ones
      const bool is_doubled = found && std::ranges::any_of(frame.layers.squares, [&](auto& square) {
                                return wrong.contains(square.id) && is_mostly_in(square, object);
                              });
      Part part;
      part.box = moments.now->boxes.at(object.object);
      if (!found || is_doubled) {
        part.cause =
            is_doubled ? EventKind::square_split : cause_of(frame, outcomes.eligible, object);
        if (is_layered) part.steps = steps_of(frame, object.object);
      }
      errors_of(objects_, object.object).add(part, part.cause.has_value(), moments);
    }
    for (const Square& square : frame.layers.squares) {
      const bool touches = std::ranges::any_of(frame.object_truth, [&](const auto& object) {
        return iou_of(object, square) >= kLeastIou || is_mostly_in(square, object);
      });
      if (touches || !wrong.contains(square.id)) continue;
      Part part;
      part.box = recording::box_of(square);
      part.cause = EventKind::square_false;
      for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
        if (part.box.contains(frame.corners_px[i].cast<double>())) add_corner(frame, i, part);
      }
      false_.try_emplace(square.id, 0).first->second.add(part, true, moments);
    }
  }

  void look(const Moment& now) {
    for (auto& [object, errors] : objects_) errors.look(now);
    for (auto& [square, errors] : false_) errors.look(now);
  }

  /// Most frames first.
  std::vector<ScoredEvent> events(const recording::RunInfo& of) const {
    std::vector<ScoredEvent> all;
    for (const auto& [object, errors] : objects_) {
      for (const Run& run : errors.runs()) {
        int frames = 0;
        for (const auto& [cause, count] : run.causes) frames += count;
        if (frames < kLeastFrames) continue;
        const auto most = std::ranges::max_element(run.causes, {},
                                                   [](const auto& cause) { return cause.second; });
        ScoredEvent& event = all.emplace_back(errors.event(most->first, run, of));
        event.frames = frames;
        event.of_frames = run.frames;
        event.steps = by_count(run.sum.steps);
        for (const auto& [step, corners] : event.steps) event.corners += corners;
      }
    }
    for (const auto& [square, errors] : false_) {
      for (const Run& run : errors.runs()) {
        if (run.frames < kLeastFrames) continue;
        all.emplace_back(errors.event(EventKind::square_false, run, of)).frames = run.frames;
      }
    }
    std::ranges::stable_sort(all, std::greater(), &ScoredEvent::frames);
    return all;
  }

 private:
  ErrorsByObject objects_;  // of frames in which a square should be there
  std::map<Id, Errors> false_;
};

}  // namespace

const EventKindText& text_of(EventKind kind) {
  return kKinds[static_cast<std::size_t>(kind)];
}

const EventKindText& text_of(SquareStep step) {
  return kSteps[static_cast<std::size_t>(step)];
}

EventSums sums_of(const std::vector<ScoredEvent>& events) {
  EventSums sums;
  for (const ScoredEvent& event : events) {
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
  add_to(missed, other.missed);
  add_to(false_ones, other.false_ones);
  add_to(squares, other.squares);
}

struct EventFinder::State {
  recording::RunInfo run;
  std::size_t frames = 0;
  Moments moments = {};
  ErrorsByObject missed = {};
  FalseGroups false_groups = {};
  SquareEvents squares = {};
};

EventFinder::EventFinder(const recording::RunInfo& run) : state_(new State{run}) {}
EventFinder::~EventFinder() = default;
EventFinder::EventFinder(EventFinder&&) noexcept = default;

void EventFinder::add(const recording::FrameRecord& frame,
                      const std::vector<CornerOutcome>& outcomes) {
  if (state_->run.truth == recording::Truth::unknown) return;  // errors are undefined without truth
  auto& [run, frames, moments, missed, false_groups, squares] = *state_;
  moments.before = std::exchange(moments.now, Moment(frames++, frame));
  for (auto& [object, errors] : missed) errors.look(*moments.now);
  false_groups.look(*moments.now);
  squares.look(*moments.now);
  if (frame.index < recording::kSightings) return;
  for (const auto& [object, part] : missed_parts(frame, outcomes, moments.now->boxes)) {
    errors_of(missed, object).add(part, 2 * part.corners > part.counted_corners, moments);
  }
  false_groups.add_frame(frame, outcomes, moments);
  if (run.truth != recording::Truth::all) return;  // the objects are unknown
  squares.add_frame(frame, run.detector.layered, moments);
}

std::vector<ScoredEvent> EventFinder::events(const ObjectDetections& detections) const {
  std::vector<ScoredEvent> events;
  for (const auto& [object, errors] : state_->missed) {
    const std::optional<int> found_at = detections.at(object).found_at;
    for (const Run& part : errors.runs()) {
      if (part.sum.corners < kCornersToFind) continue;
      const EventKind kind = !found_at                      ? EventKind::never_found
                             : *found_at > part.first_frame ? EventKind::found_late
                                                            : EventKind::lost;
      events.push_back(errors.event(kind, part, state_->run));
    }
  }
  state_->false_groups.add_to(events, state_->run);
  const auto rank = [](const ScoredEvent& event) {  // rebel events have no circles
    return std::tuple(family_of(event.kind), -event.circles, -event.corners);
  };
  std::ranges::stable_sort(events, {}, rank);
  std::ranges::move(state_->squares.events(state_->run), std::back_inserter(events));
  return events;
}

void keep_worst(std::vector<ScoredEvent>& events, std::size_t most) {
  std::map<EventFamily, std::size_t> kept;
  std::erase_if(events,
                [&](const ScoredEvent& event) { return kept[family_of(event.kind)]++ >= most; });
}

}  // namespace lcs::scoring
