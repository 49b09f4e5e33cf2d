#include "tools/scoring/score_rebels.h"

#include <algorithm>
#include <map>
#include <set>

#include "tools/recording/box.h"

namespace lcs::bench {
namespace {

/// The frames in which an object is distinct: a corner of it is labelled rebel.
struct Distinct {
  int first = 0;  ///< k0
  int frames = 0;
};

std::map<int, Distinct> distinct_objects(const Recording& recording) {
  std::map<int, Distinct> found;
  for (const FrameRecord& frame : recording.frames) {
    std::set<int> objects;
    for (const sim::CornerTruth& truth : frame.corner_truth) {
      if (truth.label == sim::Label::rebel) objects.insert(truth.object);
    }
    for (const int object : objects) {
      const auto [entry, is_new] = found.try_emplace(object, Distinct{frame.index, 0});
      ++entry->second.frames;
    }
  }
  return found;
}

CornerOutcome outcome(bool said_rebel, sim::Label label, bool counted_by_recall) {
  if (label == sim::Label::fixed) {
    return said_rebel ? CornerOutcome::false_rebel : CornerOutcome::fixed;
  }
  if (counted_by_recall) return said_rebel ? CornerOutcome::found : CornerOutcome::missed;
  return said_rebel ? CornerOutcome::found_early : CornerOutcome::missed_early;
}

RebelCounts counts(CornerOutcome outcome) {
  RebelCounts counts;
  const bool found = outcome == CornerOutcome::found;
  counts.true_rebels = found || outcome == CornerOutcome::found_early;
  counts.false_rebels = outcome == CornerOutcome::false_rebel;
  counts.found_rebels = found;
  counts.missed_rebels = outcome == CornerOutcome::missed;
  return counts;
}

/// The outcome as if the verdict were right.
CornerOutcome corrected(CornerOutcome outcome) {
  switch (outcome) {
    case CornerOutcome::false_rebel:
      return CornerOutcome::fixed;
    case CornerOutcome::missed:
      return CornerOutcome::found;
    case CornerOutcome::missed_early:
      return CornerOutcome::found_early;
    default:
      return outcome;
  }
}

Difficulty difficulty(const FrameRecord& frame, std::size_t corner) {
  const sim::CornerTruth& truth = frame.corner_truth[corner];
  if (truth.outline) return Difficulty::outline;
  if (truth.label == sim::Label::rebel && truth.radial) return Difficulty::radial;
  const Reason reason = frame.reasons.empty() ? Reason::unknown : frame.reasons[corner];
  const bool first = reason == Reason::first_sighting || reason == Reason::inherited;
  return first ? Difficulty::first_seen : Difficulty::tracked;
}

/// The number of corners on an object with the verdict rebel.
int rebels_on(const FrameRecord& frame, int object) {
  int rebels = 0;
  for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
    rebels += frame.corner_truth[i].object == object && frame.verdicts[i] == Verdict::rebel;
  }
  return rebels;
}

/// The first frame from k0 on with `kCornersToFind` rebel corners on the object.
std::optional<int> found_at(const Recording& recording, int object, int k0) {
  for (const FrameRecord& frame : recording.frames) {
    if (frame.index >= k0 && rebels_on(frame, object) >= kCornersToFind) return frame.index;
  }
  return std::nullopt;
}

std::set<int> moving_objects(const FrameRecord& frame) {
  std::set<int> moving;
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    if (truth.moving) moving.insert(truth.object);
  }
  return moving;
}

}  // namespace

RebelCornerScore& RebelCornerScore::operator+=(const RebelCornerScore& other) {
  overall += other.overall;
  distinct += other.distinct;
  clear += other.clear;
  radial += other.radial;
  fixed_corners += other.fixed_corners;
  for (std::size_t d = 0; d < without.size(); ++d) without[d] += other.without[d];
  return *this;
}

std::vector<std::vector<CornerOutcome>> corner_outcomes(const Recording& recording) {
  const std::map<int, Distinct> distinct = distinct_objects(recording);
  std::vector<std::vector<CornerOutcome>> outcomes;
  for (const FrameRecord& frame : recording.frames) {
    auto& of_frame = outcomes.emplace_back(frame.corner_truth.size(), CornerOutcome::uncounted);
    if (frame.index < kSightings) continue;
    for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
      const sim::CornerTruth& truth = frame.corner_truth[i];
      const bool is_rebel = truth.label == sim::Label::rebel;
      if (!is_rebel && truth.label != sim::Label::fixed) continue;
      const bool by_recall =
          is_rebel && frame.index >= distinct.at(truth.object).first + kSightings;
      of_frame[i] = outcome(frame.verdicts[i] == Verdict::rebel, truth.label, by_recall);
    }
  }
  return outcomes;
}

std::vector<RebelCornerScore> score_rebel_corners(const Recording& recording) {
  std::vector<RebelCornerScore> scores;
  for (const std::vector<CornerOutcome>& outcomes : corner_outcomes(recording)) {
    const FrameRecord& frame = recording.frames[scores.size()];
    RebelCornerScore& score = scores.emplace_back();
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      const sim::CornerTruth& truth = frame.corner_truth[i];
      const RebelCounts of_corner = counts(outcomes[i]);
      score.overall += of_corner;
      const bool is_radial = truth.label == sim::Label::rebel && truth.radial;
      (is_radial ? score.radial : score.distinct) += of_corner;
      if (!truth.outline) score.clear += of_corner;
      const auto hard = static_cast<std::size_t>(difficulty(frame, i));
      for (std::size_t d = 0; d < score.without.size(); ++d) {
        score.without[d] += d == hard ? counts(corrected(outcomes[i])) : of_corner;
      }
      score.fixed_corners +=
          outcomes[i] == CornerOutcome::fixed || outcomes[i] == CornerOutcome::false_rebel;
    }
  }
  return scores;
}

std::vector<ObjectDetection> detect_objects(const Recording& recording) {
  std::vector<ObjectDetection> detections;
  for (const auto& [object, distinct] : distinct_objects(recording)) {
    detections.push_back({.object = object,
                          .first_distinct = distinct.first,
                          .distinct_frames = distinct.frames,
                          .found_at = found_at(recording, object, distinct.first)});
  }
  return detections;
}

bool has_mover_under(const FrameRecord& frame, const Vec2& centre_px, double radius_px) {
  const bool centre_in_box = std::any_of(frame.object_truth.begin(), frame.object_truth.end(),
                                         [&](const sim::ObjectTruth& truth) {
                                           return truth.moving && box_of(truth).contains(centre_px);
                                         });
  if (centre_in_box) return true;
  const std::set<int> moving = moving_objects(frame);
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    const double distance = (frame.corners_px[i].cast<double>() - centre_px).norm();
    if (distance <= radius_px && moving.contains(frame.corner_truth[i].object)) return true;
  }
  return false;
}

std::vector<const Circle*> false_circles(const FrameRecord& frame) {
  std::vector<const Circle*> alone;
  for (const Circle& circle : frame.layers.rebel_circles) {
    if (!has_mover_under(frame, circle.location, circle.radius)) alone.push_back(&circle);
  }
  return alone;
}

RebelObjectScore score_rebel_objects(const Recording& recording) {
  RebelObjectScore score;
  for (const ObjectDetection& object : detect_objects(recording)) {
    if (object.distinct_frames < kSightings) continue;
    ++score.objects;
    if (!object.found_at) continue;
    ++score.found;
    score.latencies.push_back(*object.found_at - object.first_distinct);
  }
  for (const FrameRecord& frame : recording.frames) {
    if (frame.index < kSightings) continue;
    ++score.frames;
    score.false_circles += static_cast<int>(false_circles(frame).size());
    for (const sim::ObjectTruth& truth : frame.object_truth) {
      if (!truth.moving || rebels_on(frame, truth.object) < kCornersToFind) continue;
      const auto& circles = frame.layers.rebel_circles;
      ++score.seen;
      score.circled += std::any_of(circles.begin(), circles.end(), [&](const Circle& circle) {
        return box_of(truth).contains(circle.location);
      });
    }
  }
  return score;
}

}  // namespace lcs::bench
