#include "tools/bench/score_rebels.h"

#include <algorithm>
#include <map>
#include <set>

namespace lcs::bench {
namespace {

/// At least this many rebel corners on an object count as having found it.
constexpr int kCornersToFind = 3;

/// In which frames an object is distinct: some corner of it is labelled rebel.
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

RebelCounts counts(bool said_rebel, sim::Label label, bool counted_by_recall) {
  RebelCounts counts;
  if (label == sim::Label::fixed) {
    counts.false_rebels = said_rebel;
  } else {
    counts.true_rebels = said_rebel;
    counts.found_rebels = said_rebel && counted_by_recall;
    counts.missed_rebels = !said_rebel && counted_by_recall;
  }
  return counts;
}

/// First frame from k0 on with enough rebel corners on the object; -1 for none.
int found_at(const Recording& recording, int object, int k0) {
  for (const FrameRecord& frame : recording.frames) {
    if (frame.index < k0) continue;
    int rebels = 0;
    for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
      rebels += frame.corner_truth[i].object == object && frame.verdicts[i] == Verdict::rebel;
    }
    if (rebels >= kCornersToFind) return frame.index;
  }
  return -1;
}

std::set<int> moving_objects(const FrameRecord& frame) {
  std::set<int> moving;
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    if (truth.moving) moving.insert(truth.object);
  }
  return moving;
}

/// Pixel edges against pixel centres: the box of pixels l to r-1 reaches from l - 1/2 to r - 1/2.
bool contains(const sim::ObjectTruth& box, const Vec2& px) {
  return px.x() >= box.left - 0.5 && px.x() <= box.right - 0.5 &&  //
         px.y() >= box.top - 0.5 && px.y() <= box.bottom - 0.5;
}

bool has_moving_object_under(const Circle& circle, const FrameRecord& frame,
                             const std::set<int>& moving) {
  const bool centre_in_box = std::any_of(frame.object_truth.begin(), frame.object_truth.end(),
                                         [&](const sim::ObjectTruth& truth) {
                                           return truth.moving && contains(truth, circle.location);
                                         });
  if (centre_in_box) return true;
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    const double distance = (frame.corners_px[i].cast<double>() - circle.location).norm();
    if (distance <= circle.radius && moving.contains(frame.corner_truth[i].object)) return true;
  }
  return false;
}

}  // namespace

RebelCornerScore& RebelCornerScore::operator+=(const RebelCornerScore& other) {
  overall += other.overall;
  distinct += other.distinct;
  radial += other.radial;
  fixed_corners += other.fixed_corners;
  return *this;
}

std::vector<RebelCornerScore> score_rebel_corners(const Recording& recording) {
  const std::map<int, Distinct> distinct = distinct_objects(recording);
  std::vector<RebelCornerScore> scores;
  for (const FrameRecord& frame : recording.frames) {
    RebelCornerScore& score = scores.emplace_back();
    if (frame.index < kSightings) continue;
    for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
      const sim::CornerTruth& truth = frame.corner_truth[i];
      const bool is_rebel = truth.label == sim::Label::rebel;
      if (!is_rebel && truth.label != sim::Label::fixed) continue;
      const bool by_recall =
          is_rebel && frame.index >= distinct.at(truth.object).first + kSightings;
      const RebelCounts of_corner =
          counts(frame.verdicts[i] == Verdict::rebel, truth.label, by_recall);
      score.overall += of_corner;
      (is_rebel && truth.radial ? score.radial : score.distinct) += of_corner;
      score.fixed_corners += !is_rebel;
    }
  }
  return scores;
}

RebelObjectScore score_rebel_objects(const Recording& recording) {
  RebelObjectScore score;
  for (const auto& [object, distinct] : distinct_objects(recording)) {
    if (distinct.frames < kSightings) continue;
    ++score.objects;
    const int found = found_at(recording, object, distinct.first);
    if (found < 0) continue;
    ++score.found;
    score.latencies.push_back(found - distinct.first);
  }
  for (const FrameRecord& frame : recording.frames) {
    if (frame.index < kSightings) continue;
    ++score.frames;
    const std::set<int> moving = moving_objects(frame);
    for (const Circle& circle : frame.layers.rebel_circles) {
      score.false_circles += !has_moving_object_under(circle, frame, moving);
    }
  }
  return score;
}

}  // namespace lcs::bench
