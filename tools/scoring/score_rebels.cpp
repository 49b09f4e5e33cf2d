#include "tools/scoring/score_rebels.h"

#include <algorithm>
#include <set>

#include "tools/recording/box.h"

namespace lcs::scoring {
namespace {

CornerOutcome outcome(bool said_rebel, sim::Label label, bool counted_by_recall) {
  if (label == sim::Label::fixed) {
    return said_rebel ? CornerOutcome::false_rebel : CornerOutcome::fixed;
  }
  if (counted_by_recall) return said_rebel ? CornerOutcome::found : CornerOutcome::missed;
  return said_rebel ? CornerOutcome::found_early : CornerOutcome::missed_early;
}

RebelCounts counts(CornerOutcome outcome) {
  const bool found = outcome == CornerOutcome::found;
  return {.true_rebels = found || outcome == CornerOutcome::found_early,
          .false_rebels = outcome == CornerOutcome::false_rebel,
          .found_rebels = found,
          .missed_rebels = outcome == CornerOutcome::missed};
}

/// The outcome as if the verdict were right.
CornerOutcome corrected(CornerOutcome outcome) {
  return outcome == CornerOutcome::false_rebel    ? CornerOutcome::fixed
         : outcome == CornerOutcome::missed       ? CornerOutcome::found
         : outcome == CornerOutcome::missed_early ? CornerOutcome::found_early
                                                  : outcome;
}

/// The number of corners with the verdict rebel, by object.
std::map<int, int> rebels_by_object(const recording::FrameRecord& frame) {
  std::map<int, int> rebels;
  for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
    if (frame.verdicts[i] == Verdict::rebel) ++rebels[frame.corner_truth[i].object];
  }
  return rebels;
}

/// Adds the corners of a frame. \return their counts.
RebelCounts add_to(RebelCornerScore& score, const recording::FrameRecord& frame,
                   const std::vector<CornerOutcome>& outcomes) {
  RebelCounts of_frame;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const sim::CornerTruth& truth = frame.corner_truth[i];
    const RebelCounts of_corner = counts(outcomes[i]);
    of_frame += of_corner;
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
  score.overall += of_frame;
  return of_frame;
}

}  // namespace

Difficulty difficulty(const recording::FrameRecord& frame, std::size_t corner) {
  const sim::CornerTruth& truth = frame.corner_truth[corner];
  if (truth.outline) return Difficulty::outline;
  if (truth.label == sim::Label::rebel && truth.radial) return Difficulty::radial;
  const Reason reason = frame.reasons.empty() ? Reason::unknown : frame.reasons[corner];
  const bool first = reason == Reason::first_sighting || reason == Reason::inherited;
  return first ? Difficulty::first_seen : Difficulty::tracked;
}

std::vector<CornerOutcome> corner_outcomes(const recording::FrameRecord& frame,
                                           const ObjectDetections& detections) {
  std::vector<CornerOutcome> outcomes(frame.corner_truth.size(), CornerOutcome::uncounted);
  if (frame.index < recording::kSightings) return outcomes;
  for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
    const sim::CornerTruth& truth = frame.corner_truth[i];
    const bool is_rebel = truth.label == sim::Label::rebel;
    if (!is_rebel && truth.label != sim::Label::fixed) continue;
    const bool by_recall = is_rebel && frame.index >= detections.at(truth.object).first_distinct +
                                                          recording::kSightings;
    outcomes[i] = outcome(frame.verdicts[i] == Verdict::rebel, truth.label, by_recall);
  }
  return outcomes;
}

FrameScore RebelScorer::add(const recording::FrameRecord& frame) {
  std::set<int> distinct;
  for (const sim::CornerTruth& truth : frame.corner_truth) {
    if (truth.label == sim::Label::rebel) distinct.insert(truth.object);
  }
  for (const int object : distinct) {
    const auto [entry, is_new] = detections_.try_emplace(object);
    if (is_new) {
      entry->second.first_distinct = frame.index;
      entry->second.first_distinct_ns = frame.t_ns;
    }
    ++entry->second.distinct_frames;
  }
  const std::map<int, int> rebels = rebels_by_object(frame);
  for (const auto& [object, count] : rebels) {
    const auto found = detections_.find(object);
    if (found == detections_.end() || found->second.found_at || count < kCornersToFind) continue;
    found->second.found_at = frame.index;
    found->second.latency_ms =
        1e-6 * static_cast<double>(frame.t_ns - found->second.first_distinct_ns);
  }
  FrameScore score{corner_outcomes(frame, detections_), {}};
  score.rebels = add_to(corners_, frame, score.outcomes);
  if (frame.index < recording::kSightings) return score;

  ++circles_.frames;
  circles_.false_circles += static_cast<int>(false_circles(frame).size());
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    const auto found = rebels.find(truth.object);
    if (!truth.moving || found == rebels.end() || found->second < kCornersToFind) continue;
    ++circles_.seen;
    circles_.circled += std::ranges::any_of(frame.layers.rebel_circles, [&](const Circle& circle) {
      return recording::box_of(truth).contains(circle.location);
    });
  }
  return score;
}

RebelObjectScore RebelScorer::objects() const {
  RebelObjectScore score = circles_;
  for (const auto& [object, detection] : detections_) {
    if (detection.distinct_frames < recording::kSightings) continue;
    ++score.objects;
    if (!detection.found_at) continue;
    ++score.found;
    score.latencies.push_back(*detection.found_at - detection.first_distinct);
    score.latencies_ms.push_back(detection.latency_ms);
  }
  return score;
}

bool has_mover_under(const recording::FrameRecord& frame, const Vec2& centre_px, double radius_px) {
  const auto has_corner_in_disc = [&](int object) {
    for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
      if (frame.corner_truth[i].object != object) continue;
      if ((frame.corners_px[i].cast<double>() - centre_px).norm() <= radius_px) return true;
    }
    return false;
  };
  return std::ranges::any_of(frame.object_truth, [&](const sim::ObjectTruth& truth) {
    return truth.moving &&
           (recording::box_of(truth).contains(centre_px) || has_corner_in_disc(truth.object));
  });
}

std::vector<const Circle*> false_circles(const recording::FrameRecord& frame) {
  std::vector<const Circle*> alone;
  for (const Circle& circle : frame.layers.rebel_circles) {
    if (!has_mover_under(frame, circle.location, circle.radius)) alone.push_back(&circle);
  }
  return alone;
}

}  // namespace lcs::scoring
