#include "tools/scoring/score_movers.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "tools/recording/box.h"
#include "tools/scoring/score_squares.h"
#include "tools/scoring/scores.h"

namespace lcs::scoring {
namespace {

constexpr double kReachOfDiagonal = 0.008;  // of a boundary, as DAVIS has it

std::vector<const Square*> moving_squares(const recording::FrameRecord& frame) {
  std::vector<const Square*> squares;
  for (const Square& square : frame.layers.squares) {
    if (may_move(square)) squares.push_back(&square);
  }
  return squares;
}

Eigen::MatrixXd overlaps(const std::vector<const sim::ObjectTruth*>& truths,
                         const std::vector<const Square*>& squares) {
  Eigen::MatrixXd overlap(truths.size(), squares.size());
  for (std::size_t i = 0; i < truths.size(); ++i) {
    for (std::size_t j = 0; j < squares.size(); ++j) {
      overlap(i, j) = iou_of(*truths[i], *squares[j]);
    }
  }
  return overlap;
}

/// Detection as in Mitrokhin et al., "Event-based moving object detection and tracking", IROS 2018:
/// the detected box D covers over half of the true one T, and more of T than of its surroundings.
bool is_detected(const recording::Box& truth, const std::vector<const Square*>& squares) {
  return std::ranges::any_of(squares, [&](const Square* square) {
    const recording::Box box = recording::box_of(*square);
    const double common = recording::common_px2(truth, box);
    return common > 0.5 * truth.volume() && common > box.volume() - common;
  });
}

/// Mean log odds of the rebel corners in the square; absent without one.
std::optional<double> odds_of(const Square& square, const recording::FrameRecord& frame) {
  const recording::Box box = recording::box_of(square);
  std::vector<double> odds;
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    if (frame.verdicts[i] != Verdict::rebel) continue;
    if (box.contains(frame.corners_px[i].cast<double>())) odds.push_back(frame.log_odds[i]);
  }
  return mean(odds);
}

}  // namespace

void MoverScorer::add(const recording::FrameRecord& frame,
                      const std::vector<CornerOutcome>& outcomes,
                      const ObjectDetections& detections) {
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    if (truth.moving) moved_.insert(truth.object);
    if (truth.mask.empty()) are_masks_known_ = false;
  }
  if (frame.index >= recording::kSightings) {
    add_boxes(frame, detections);
    if (picture_px_ && are_masks_known_) add_pixels(frame);
    if (!frame.log_odds.empty()) add_corners(frame, outcomes);
  }
  last_ns_ = frame.t_ns;
}

void MoverScorer::add_boxes(const recording::FrameRecord& frame,
                            const ObjectDetections& detections) {
  const std::set<int> eligible = eligible_objects(frame);
  // Squares on a mover that need not be found, as it rests or is hidden, are neither right nor
  // wrong. They are left out first, as MOTChallenge leaves out those on its distractors.
  std::vector<const sim::ObjectTruth*> wanted, all;
  bool does_any_move = false;
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    does_any_move |= truth.moving;
    if (truth.moving && eligible.contains(truth.object)) wanted.push_back(&truth);
    if (moved_.contains(truth.object)) all.push_back(&truth);
  }
  std::vector<const Square*> squares = moving_squares(frame);
  Eigen::MatrixXd worth = overlaps(all, squares);
  worth = (worth.array() < kRightIou).select(0, worth);
  for (const auto& [i, j] : best_pairs(worth)) {
    if (!(worth(i, j) > 0)) continue;
    if (const auto distinct = detections.find(all[i]->object); distinct != detections.end()) {
      const auto since_ns = static_cast<double>(frame.t_ns - distinct->second.first_distinct_ns);
      boxed_ms_.try_emplace(all[i]->object, 1e-6 * since_ns);
    }
    if (std::ranges::find(wanted, all[i]) == wanted.end()) squares[j] = nullptr;
  }
  std::erase(squares, nullptr);

  if (!does_any_move) {
    sums_.still_s += 1e-9 * static_cast<double>(frame.t_ns - last_ns_);
    for (const Square* square : squares) false_tracks_.insert(square->id);
  }
  FrameBoxes boxes{{}, {}, overlaps(wanted, squares)};
  for (const sim::ObjectTruth* truth : wanted) {
    ++sums_.boxes;
    sums_.detected += is_detected(recording::box_of(*truth), squares);
    boxes.objects.push_back(
        objects_.try_emplace(truth->object, std::ssize(objects_)).first->second);
  }
  for (const Square* square : squares) {
    boxes.tracks.push_back(tracks_.try_emplace(square->id, std::ssize(tracks_)).first->second);
  }
  if (!frame.log_odds.empty()) rank(frame, squares, boxes.overlap);
  if (!wanted.empty() || !squares.empty()) frames_.push_back(std::move(boxes));
}

/// Matches squares and boxes as COCO does: the squares by falling odds, each with the best box that
/// is left.
void MoverScorer::rank(const recording::FrameRecord& frame,
                       const std::vector<const Square*>& squares, const Eigen::MatrixXd& overlap) {
  has_odds_ = true;
  std::vector<std::pair<double, Eigen::Index>> order;
  for (std::size_t j = 0; j < squares.size(); ++j) {
    // A body that is carried on without a corner has no odds of its own in this frame: even ones.
    order.emplace_back(-odds_of(*squares[j], frame).value_or(0), j);
  }
  std::ranges::stable_sort(order, {}, &std::pair<double, Eigen::Index>::first);
  std::vector<char> taken(overlap.rows(), 0);
  for (const auto& [odds, j] : order) {
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < overlap.rows(); ++i) {
      if (taken[i] || overlap(i, j) < (best < 0 ? kRightIou : overlap(best, j))) continue;
      best = i;
    }
    if (best >= 0) taken[best] = 1;
    boxes_.push_back({-odds, best >= 0});
  }
}

void MoverScorer::add_pixels(const recording::FrameRecord& frame) {
  cv::Mat1b truth(*picture_px_, 0), found(*picture_px_, 0);
  for (const sim::ObjectTruth& object : frame.object_truth) {
    if (object.moving) paint(sim::mask_of(object), truth);
  }
  if (cv::countNonZero(truth) == 0) return;
  for (const Square* square : moving_squares(frame)) paint(*square, frame.masks, found);
  const int common = cv::countNonZero(truth & found), all = cv::countNonZero(truth | found);
  sums_.common_px += common;
  sums_.all_px += all;
  sums_.region_j.push_back(static_cast<double>(common) / all);
  const cv::Size size = *picture_px_;
  const int reach =
      static_cast<int>(std::ceil(kReachOfDiagonal * std::hypot(size.width, size.height)));
  // No pixel beyond the reach of both masks counts.
  cv::Rect near = cv::boundingRect(truth | found);
  near = cv::Rect(near.tl() - cv::Point(reach + 1, reach + 1),
                  near.br() + cv::Point(reach + 1, reach + 1)) &
         cv::Rect(cv::Point(), size);
  sums_.boundary_f.push_back(boundary_f(truth(near), found(near), reach));
}

void MoverScorer::add_corners(const recording::FrameRecord& frame,
                              const std::vector<CornerOutcome>& outcomes) {
  has_odds_ = true;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const CornerOutcome outcome = outcomes[i];
    const bool is_rebel = outcome == CornerOutcome::found || outcome == CornerOutcome::missed;
    const bool is_fixed = outcome == CornerOutcome::fixed || outcome == CornerOutcome::false_rebel;
    if (!is_rebel && !is_fixed) continue;
    Found& found = corners_[frame.log_odds[i]];
    ++(is_rebel ? found.right : found.wrong);
  }
}

MoverScore MoverScorer::score(const ObjectDetections& detections) const {
  MoverScore score = sums_;
  score.false_tracks = static_cast<int>(false_tracks_.size());
  for (const auto& [object, ms] : boxed_ms_) {
    const bool is_mover = detections.at(object).distinct_frames >= recording::kSightings;
    if (is_mover) score.latencies_ms.push_back(ms);
  }
  if (score.boxes > 0) score.tracks = measure_tracks(frames_);
  const auto add = [](std::vector<Found>& curve, std::int64_t right, std::int64_t wrong) {
    const Found last = curve.empty() ? Found{} : curve.back();
    curve.push_back({last.right + right, last.wrong + wrong});
  };
  if (!has_odds_) return score;
  std::vector<Found> curve;
  for (const auto& [odds, found] : corners_) add(curve, found.right, found.wrong);
  if (!curve.empty() && curve.back().right > 0) {
    score.corner_precision = average_precision(curve, curve.back().right);
  }
  std::vector<Box> ranked = boxes_;
  std::ranges::stable_sort(ranked, std::greater<>(), &Box::odds);
  curve.clear();
  for (const Box& box : ranked) add(curve, box.right, !box.right);
  if (score.boxes > 0) score.box_precision = average_precision(curve, score.boxes);
  return score;
}

}  // namespace lcs::scoring
