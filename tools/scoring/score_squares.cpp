#include "tools/scoring/score_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "tools/scoring/scoring.h"

namespace lcs::scoring {
namespace {

constexpr double kRim_px = 1e-6;

/// Pixels whose centres lie in [from, to] or within `kRim_px` of it, of `size`.
cv::Range pixels(double from, double to, int size) {
  const int first = static_cast<int>(std::ceil(std::clamp<double>(from, 0, size) - kRim_px));
  const int last = static_cast<int>(std::floor(std::clamp<double>(to, -1, size - 1) + kRim_px));
  return {first, std::max(first, last + 1)};
}

void paint_column(int column, const cv::Range& rows, cv::Mat1b& picture) {
  picture(rows, cv::Range(column, column + 1)) = 255;
}

/// \name Conditions for an eligible truth box, which a square should find.
///@{
constexpr int kMinArea_px2 = 400;
constexpr int kMinCorners = 4;
constexpr double kMinVisibleFraction = 0.5;
///@}

/// The overlaps of the squares and objects of one frame, before any threshold.
struct FrameSquares {
  std::set<int> eligible;         ///< objects
  std::vector<BoxPair> pairs;     ///< one-to-one matches of eligible objects and squares
  std::vector<BoxPair> best_box;  ///< each square's best among all boxes; object 0: no overlap
};

FrameSquares compare_boxes(const recording::FrameRecord& frame) {
  FrameSquares result;
  result.eligible = eligible_objects(frame);
  std::vector<BoxPair> candidates;
  for (const Square& square : frame.layers.squares) {
    BoxPair best{0, 0, square.id};
    for (const sim::ObjectTruth& truth : frame.object_truth) {
      const double iou = iou_of(truth, square);
      const bool eligible = result.eligible.contains(truth.object);
      if (iou > 0 && eligible) candidates.push_back({iou, truth.object, square.id});
      if (iou > best.iou || (iou == best.iou && iou > 0 && eligible)) {
        best = {iou, truth.object, square.id};
      }
    }
    result.best_box.push_back(best);
  }

  result.pairs = one_to_one(std::move(candidates));
  return result;
}

SquareOutcomes outcomes_of(const FrameSquares& squares, double threshold) {
  SquareOutcomes outcomes{squares.eligible, {}, {}};
  std::set<Id> right;
  for (const BoxPair& pair : squares.pairs) {
    if (pair.iou < threshold) continue;
    outcomes.right.push_back(pair);
    right.insert(pair.square);
  }
  for (const BoxPair& best : squares.best_box) {
    const bool is_on_other = best.iou >= threshold && !squares.eligible.contains(best.box);
    if (!right.contains(best.square) && !is_on_other) outcomes.wrong.push_back(best.square);
  }
  return outcomes;
}

void add_to(SquareCounts& sum, const SquareOutcomes& outcomes) {
  const auto right = static_cast<int>(outcomes.right.size());
  sum.boxes += static_cast<int>(outcomes.eligible.size());
  sum.matched += right;
  sum.squares += right + static_cast<int>(outcomes.wrong.size());
}

}  // namespace

std::set<int> eligible_objects(const recording::FrameRecord& frame) {
  std::set<int> objects;
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    const int area = (truth.right - truth.left) * (truth.bottom - truth.top);
    const auto corners =
        std::ranges::count(frame.corner_truth, truth.object, &sim::CornerTruth::object);
    if (area >= kMinArea_px2 && corners >= kMinCorners &&
        truth.visible_fraction >= kMinVisibleFraction) {
      objects.insert(truth.object);
    }
  }
  return objects;
}

void paint(const sim::Mask& mask, cv::Mat1b& picture) {
  sim::visit_stretches(mask, [&](int column, int top, int bottom) {
    if (column < 0 || column >= picture.cols) return;
    paint_column(column, pixels(top, bottom - 1, picture.rows), picture);
  });
}

void paint(const Outline& outline, cv::Mat1b& picture) {
  const std::span<const Vec2> polygon = outline.vertices();
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (const Vec2& point : polygon) {
    left = std::min(left, point.x());
    right = std::max(right, point.x());
  }
  if (polygon.empty()) return;
  const cv::Range columns = pixels(left, right, picture.cols);
  for (int column = columns.start; column < columns.end; ++column) {
    double top = std::numeric_limits<double>::infinity(), bottom = -top;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if (column < std::min(a.x(), b.x()) - kRim_px || column > std::max(a.x(), b.x()) + kRim_px) {
        continue;
      }
      const double wide = b.x() - a.x();
      const auto y_at = [&](double share) { return a.y() + share * (b.y() - a.y()); };
      // A vertical side lies in the column with its whole length.
      const bool is_upright = std::abs(wide) <= kRim_px;
      const double there = is_upright ? 0 : std::clamp((column - a.x()) / wide, 0.0, 1.0);
      for (const double y : {y_at(there), y_at(is_upright ? 1 : there)}) {
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
    paint_column(column, pixels(top, bottom, picture.rows), picture);
  }
}

void paint(const recording::Box& box, cv::Mat1b& picture) {
  picture(pixels(box.min().y(), box.max().y(), picture.rows),
          pixels(box.min().x(), box.max().x(), picture.cols)) = 255;
}

void paint(const Square& square, const recording::SquareMasks& masks, cv::Mat1b& picture) {
  if (const auto mask = masks.find(square.id); mask != masks.end()) {
    paint(mask->second, picture);
  } else if (square.outline.count > 0) {
    paint(square.outline, picture);
  } else {
    paint(recording::box_of(square), picture);
  }
}

SquareOutcomes square_outcomes(const recording::FrameRecord& frame) {
  return outcomes_of(compare_boxes(frame), kRightIou);
}

std::vector<BoxPair> one_to_one(std::vector<BoxPair> pairs) {
  std::ranges::sort(
      pairs, {}, [](const BoxPair& pair) { return std::tuple(-pair.iou, pair.box, pair.square); });
  std::set<int> taken_boxes;
  std::set<Id> taken_squares;
  std::vector<BoxPair> matched;
  for (const BoxPair& pair : pairs) {
    if (taken_boxes.contains(pair.box) || taken_squares.contains(pair.square)) continue;
    taken_boxes.insert(pair.box);
    taken_squares.insert(pair.square);
    matched.push_back(pair);
  }
  return matched;
}

void SquareScorer::add(const recording::FrameRecord& frame) {
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    if (truth.moving) movers_.insert(truth.object);
  }
  if (frame.index < recording::kSightings) return;
  const FrameSquares squares = compare_boxes(frame);
  add_to(sums_.at_30, outcomes_of(squares, 0.3));
  add_to(sums_.at_50, outcomes_of(squares, kRightIou));
  add_to(sums_.at_70, outcomes_of(squares, 0.7));
  for (const int object : squares.eligible) ++boxes_[object];
  for (const BoxPair& pair : squares.pairs) {
    if (pair.iou < kRightIou) continue;
    pairs_.push_back({pair.box, pair.iou});
    const auto [last, first_time] = last_square_.try_emplace(pair.box, pair.square);
    sums_.identity_switches += last->second != pair.square;
    last->second = pair.square;
  }
}

SquareScore SquareScorer::score() const {
  SquareScore score = sums_;
  for (const auto& [object, boxes] : boxes_) {
    (movers_.contains(object) ? score.movers_50 : score.static_50).boxes += boxes;
  }
  for (const Pair& pair : pairs_) {
    const bool mover = movers_.contains(pair.object);
    ++(mover ? score.movers_50 : score.static_50).matched;
    (mover ? score.movers_iou : score.static_iou).push_back(pair.iou);
  }
  return score;
}

}  // namespace lcs::scoring
