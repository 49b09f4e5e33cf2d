#include "tools/scoring/score_movers.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "tools/recording/box.h"
#include "tools/scoring/score_squares.h"
#include "tools/scoring/scores.h"

namespace lcs::scoring {
namespace {

constexpr double kTrackMatch = 0.5;
constexpr double kRounding = std::numeric_limits<double>::epsilon();

/// A matched pair of a frame.
struct Match {
  int object, track;
  double overlap;
};

struct Counts {
  Eigen::VectorXd objects, tracks;  ///< boxes of each
};

Counts count(std::span<const FrameBoxes> frames) {
  int objects = 0, tracks = 0;
  for (const FrameBoxes& frame : frames) {
    for (const int object : frame.objects) objects = std::max(objects, object + 1);
    for (const int track : frame.tracks) tracks = std::max(tracks, track + 1);
  }
  Counts counts{Eigen::VectorXd::Zero(objects), Eigen::VectorXd::Zero(tracks)};
  for (const FrameBoxes& frame : frames) {
    counts.objects(frame.objects).array() += 1;
    counts.tracks(frame.tracks).array() += 1;
  }
  return counts;
}

/// How much the boxes of each object and track overlap over all frames, relative to their number.
Eigen::MatrixXd alignment(std::span<const FrameBoxes> frames, const Counts& counts) {
  Eigen::MatrixXd common = Eigen::MatrixXd::Zero(counts.objects.size(), counts.tracks.size());
  for (const FrameBoxes& frame : frames) {
    const Eigen::ArrayXXd overlap = frame.overlap;
    const Eigen::ArrayXXd all = overlap.rowwise().sum().replicate(1, overlap.cols()) +
                                overlap.colwise().sum().replicate(overlap.rows(), 1) - overlap;
    common(frame.objects, frame.tracks).array() += (all > kRounding).select(overlap / all, 0);
  }
  const Eigen::MatrixXd all = counts.objects.replicate(1, counts.tracks.size()) +
                              counts.tracks.transpose().replicate(counts.objects.size(), 1);
  return common.cwiseQuotient(all - common);
}

void measure_hota(std::span<const FrameBoxes> frames, const Counts& counts,
                  TrackMeasures& measures) {
  const Eigen::MatrixXd aligned = alignment(frames, counts);
  std::vector<Match> matches;
  for (const FrameBoxes& frame : frames) {
    const Eigen::MatrixXd worth = aligned(frame.objects, frame.tracks).cwiseProduct(frame.overlap);
    for (const auto& [i, j] : best_pairs(worth)) {
      matches.push_back({frame.objects[i], frame.tracks[j], frame.overlap(i, j)});
    }
  }
  constexpr int kThresholds = 19;
  const double boxes = counts.objects.sum() + counts.tracks.sum();
  for (int step = 1; step <= kThresholds; ++step) {
    std::map<std::pair<int, int>, int> together;
    int right = 0;
    for (const Match& match : matches) {
      if (match.overlap < 0.05 * step - kRounding) continue;
      ++right;
      ++together[{match.object, match.track}];
    }
    double associated = 0;
    for (const auto& [pair, times] : together) {
      const double all = counts.objects[pair.first] + counts.tracks[pair.second] - times;
      associated += times * (times / all);
    }
    const double detection = right / (boxes - right);
    const double association = associated / std::max(1, right);
    measures.detection += detection;
    measures.association += association;
    measures.hota += std::sqrt(detection * association);
  }
  for (double* sum : {&measures.hota, &measures.detection, &measures.association}) {
    *sum /= kThresholds;  // once, so that right tracks have exactly 1
  }
}

void measure_mota(std::span<const FrameBoxes> frames, const Counts& counts,
                  TrackMeasures& measures) {
  // A pair of the frame before is kept if it still overlaps enough.
  constexpr double kKept = 1000;
  std::map<int, int> before, last;  // the track of each object: in the frame before, ever
  int right = 0;
  for (const FrameBoxes& frame : frames) {
    if (frame.objects.empty() || frame.tracks.empty()) continue;
    Eigen::MatrixXd worth = frame.overlap;
    for (Eigen::Index i = 0; i < worth.rows(); ++i) {
      const auto track = before.find(frame.objects[i]);
      for (Eigen::Index j = 0; j < worth.cols(); ++j) {
        if (worth(i, j) < kTrackMatch - kRounding) {
          worth(i, j) = 0;
        } else if (track != before.end() && track->second == frame.tracks[j]) {
          worth(i, j) += kKept;
        }
      }
    }
    before.clear();
    for (const auto& [i, j] : best_pairs(worth)) {
      if (!(worth(i, j) > 0)) continue;
      ++right;
      const int object = frame.objects[i], track = frame.tracks[j];
      before[object] = track;
      const auto [entry, is_first] = last.try_emplace(object, track);
      measures.identity_changes += entry->second != track;
      entry->second = track;
    }
  }
  const double wrong = counts.tracks.sum() - right;
  measures.mota = (right - wrong - measures.identity_changes) / counts.objects.sum();
}

void measure_idf1(std::span<const FrameBoxes> frames, const Counts& counts,
                  TrackMeasures& measures) {
  Eigen::MatrixXd together = Eigen::MatrixXd::Zero(counts.objects.size(), counts.tracks.size());
  for (const FrameBoxes& frame : frames) {
    together(frame.objects, frame.tracks).array() +=
        (frame.overlap.array() >= kTrackMatch).cast<double>();
  }
  double right = 0;
  for (const auto& [object, track] : best_pairs(together)) right += together(object, track);
  measures.idf1 = 2 * right / (counts.objects.sum() + counts.tracks.sum());
}

/// The pixels with a neighbour to the right, below or both that differs.
cv::Mat1b boundary(const cv::Mat1b& mask) {
  cv::Mat1b wide;
  cv::copyMakeBorder(mask, wide, 0, 1, 0, 1, cv::BORDER_REPLICATE);
  const cv::Rect here(cv::Point(), mask.size());
  const cv::Mat rim = (mask != wide(here + cv::Point(1, 0))) |
                      (mask != wide(here + cv::Point(0, 1))) |
                      (mask != wide(here + cv::Point(1, 1)));
  return rim;
}

/// The share of the pixels of `of` that lie within a disc round one of `to`.
double near_share(const cv::Mat1b& of, const cv::Mat1b& to, const cv::Mat1b& disc) {
  cv::Mat1b reached;
  cv::dilate(to, reached, disc);
  return static_cast<double>(cv::countNonZero(of & reached)) / cv::countNonZero(of);
}

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

std::vector<std::pair<int, int>> best_pairs(const Eigen::MatrixXd& worth) {
  if (worth.rows() > worth.cols()) {
    std::vector<std::pair<int, int>> pairs = best_pairs(worth.transpose());
    for (auto& [row, column] : pairs) std::swap(row, column);
    std::ranges::sort(pairs);
    return pairs;
  }
  // Index 0 is a column of no row: each new row starts an alternating path there.
  const int rows = static_cast<int>(worth.rows()), columns = static_cast<int>(worth.cols());
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> row_price(rows + 1, 0), column_price(columns + 1, 0);
  std::vector<int> row_of(columns + 1, 0);
  for (int row = 1; row <= rows; ++row) {
    std::vector<double> least(columns + 1, kFar);
    std::vector<int> from(columns + 1, 0);
    std::vector<char> done(columns + 1, 0);
    row_of[0] = row;
    int column = 0;
    do {
      done[column] = 1;
      const int at = row_of[column];
      double step = kFar;
      int next = 0;
      for (int c = 1; c <= columns; ++c) {
        if (done[c]) continue;
        const double cost = -worth(at - 1, c - 1) - row_price[at] - column_price[c];
        if (cost < least[c]) {
          least[c] = cost;
          from[c] = column;
        }
        if (least[c] < step) {
          step = least[c];
          next = c;
        }
      }
      for (int c = 0; c <= columns; ++c) {
        if (done[c]) {
          row_price[row_of[c]] += step;
          column_price[c] -= step;
        } else {
          least[c] -= step;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    for (; column != 0; column = from[column]) row_of[column] = row_of[from[column]];
  }
  std::vector<std::pair<int, int>> pairs;
  for (int c = 1; c <= columns; ++c) {
    if (row_of[c] != 0) pairs.emplace_back(row_of[c] - 1, c - 1);
  }
  std::ranges::sort(pairs);
  return pairs;
}

TrackMeasures measure_tracks(std::span<const FrameBoxes> frames) {
  const Counts counts = count(frames);
  TrackMeasures measures;
  measure_hota(frames, counts, measures);
  measure_mota(frames, counts, measures);
  measure_idf1(frames, counts, measures);
  return measures;
}

double average_precision(std::span<const Found> curve, std::int64_t positives) {
  constexpr int kRecalls = 101;
  const auto precision = [](const Found& at) {
    const std::int64_t all = at.right + at.wrong;
    return all > 0 ? static_cast<double>(at.right) / static_cast<double>(all) : 0;
  };
  double sum = 0, best = 0;
  std::size_t left = curve.size();
  for (int step = kRecalls - 1; step >= 0; --step) {
    const double recall = step * 0.01;  // rounded as COCO does
    for (; left > 0; --left) {
      const Found& at = curve[left - 1];
      if (static_cast<double>(at.right) / static_cast<double>(positives) < recall) break;
      best = std::max(best, precision(at));
    }
    sum += best;
  }
  return sum / kRecalls;
}

double boundary_f(const cv::Mat1b& a, const cv::Mat1b& b, int reach_px) {
  const cv::Mat1b rim_a = boundary(a), rim_b = boundary(b);
  const bool has_a = cv::countNonZero(rim_a) > 0, has_b = cv::countNonZero(rim_b) > 0;
  if (!has_a || !has_b) return has_a == has_b ? 1 : 0;
  cv::Mat1b disc(2 * reach_px + 1, 2 * reach_px + 1);
  for (int y = -reach_px; y <= reach_px; ++y) {
    for (int x = -reach_px; x <= reach_px; ++x) {
      disc(y + reach_px, x + reach_px) = x * x + y * y <= reach_px * reach_px;
    }
  }
  const double precision = near_share(rim_a, rim_b, disc), recall = near_share(rim_b, rim_a, disc);
  return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
}

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
