/// \file
/// Scores how well squares cover the visible objects, by boxes; and the pixels that they cover.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "sim/truth/mask.h"
#include "tools/recording/box.h"
#include "tools/recording/recording.h"
#include "tools/scoring/statistics.h"

namespace lcs::scoring {

/// Counts at one IoU threshold (intersection over union).
struct SquareCounts {
  int boxes = 0;    ///< eligible truth boxes
  int matched = 0;  ///< boxes matched by a square
  int squares = 0;  ///< right and wrong squares; those on ineligible objects are neither

  std::optional<double> recall() const { return ratio(matched, boxes); }
  std::optional<double> precision() const { return ratio(matched, squares); }
};

/// Intersection over union of the boxes of objects, labels or squares.
double iou_of(const auto& a, const auto& b) {
  return recording::intersection_over_union(recording::box_of(a), recording::box_of(b));
}

/// A box and a square that overlap.
struct BoxPair {
  double iou = 0;
  int box = 0;  ///< object number, or any other unique number
  Id square = 0;
};

/// Numbers of a frame's eligible objects: large, visible and with corners enough.
std::set<int> eligible_objects(const recording::FrameRecord& frame);

/// Matches boxes and squares one to one, greedily by IoU. Ids break ties, so that the result does
/// not depend on the order of the pairs.
std::vector<BoxPair> one_to_one(std::vector<BoxPair> pairs);

/// The least IoU of a right square.
inline constexpr double kRightIou = 0.5;

/// The right and the wrong squares of a frame.
struct SquareOutcomes {
  std::set<int> eligible;      ///< objects that squares should find
  std::vector<BoxPair> right;  ///< pairs with an IoU of at least `kRightIou`
  std::vector<Id> wrong;       ///< wrong squares; squares on ineligible objects are in neither
};
SquareOutcomes square_outcomes(const recording::FrameRecord& frame);

struct SquareScore {
  SquareCounts at_30, at_50, at_70;
  /// \name At 0.5, split by whether the object moves at any time in the run.
  ///@{
  SquareCounts movers_50, static_50;           ///< `squares` is 0: wrong squares have no object
  std::vector<double> movers_iou, static_iou;  ///< of the matched pairs
  ///@}
  int identity_switches = 0;  ///< at an IoU of 0.5
};

/// Scores a run frame by frame, in order. Keeps 16 bytes for each matched pair: the objects that
/// move at any time in the run are known at its end only.
class SquareScorer {
 public:
  void add(const recording::FrameRecord& frame);
  SquareScore score() const;

 private:
  struct Pair {
    int object;
    double iou;
  };

  SquareScore sums_;  ///< without the split by movers
  std::set<int> movers_;
  std::map<int, int> boxes_;       ///< eligible ones, by object
  std::map<int, Id> last_square_;  ///< matched last, by object
  std::vector<Pair> pairs_;        ///< at `kRightIou`
};

/// \name Sets the pixels of a region that lie in the picture.
///@{
void paint(const sim::Mask& mask, cv::Mat1b& picture);
/// The pixels whose centre lies inside or within 1e-6 px of the rim. A polygon that is not convex
/// covers each column from its highest to its lowest point.
void paint(const Outline& outline, cv::Mat1b& picture);
void paint(const recording::Box& box, cv::Mat1b& picture);  ///< likewise
/// The mask of a square, otherwise its outline, otherwise its box.
void paint(const Square& square, const recording::SquareMasks& masks, cv::Mat1b& picture);
///@}

}  // namespace lcs::scoring
