/// \file
/// How well squares cover the visible objects.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::bench {

/// Counts at one threshold of IoU (intersection over union).
struct SquareCounts {
  int boxes = 0;    ///< eligible truth boxes
  int matched = 0;  ///< of these
  int squares = 0;  ///< right or wrong; those on objects that are not eligible count as neither

  std::optional<double> recall() const;
  std::optional<double> precision() const;
};

/// A box and a square that overlap.
struct BoxPair {
  double iou = 0;
  int box = 0;  ///< its object, or any other number that tells it from other boxes
  Id square = 0;
};

/// Matches boxes and squares one to one, greedily, best first. Ids settle ties, so that the order
/// in which pairs come does not matter.
std::vector<BoxPair> one_to_one(std::vector<BoxPair> pairs);

/// \name When a square is right, and which objects squares should find.
///@{
inline constexpr double kRightIou = 0.5;
/// Numbers of a frame's objects that count: large enough, with corners, and visible enough.
std::set<int> eligible_objects(const FrameRecord& frame);
///@}

/// Which squares of a frame are right, and which wrong.
struct SquareOutcomes {
  std::set<int> eligible;
  std::vector<BoxPair> right;  ///< pairs at `kRightIou` or over
  std::vector<Id> wrong;       ///< squares; those that are neither are on no eligible object
};
SquareOutcomes square_outcomes(const FrameRecord& frame);

struct SquareScore {
  SquareCounts at_30, at_50, at_70;
  /// \name At 0.5, by whether the object moves at any time in the run.
  ///@{
  SquareCounts movers_50, static_50;  ///< their `squares` are 0: a wrong square is of neither kind
  std::vector<double> movers_iou, static_iou;  ///< of matched pairs
  ///@}
  int identity_switches = 0;  ///< at 0.5
  /// The same, with the pixels that squares and objects cover in place of their boxes.
  struct Masks {
    SquareCounts at_50;
    /// IoU of the pairs whose boxes match at 0.5.
    std::vector<double> movers_iou, static_iou;
  };
  std::optional<Masks> masks;  ///< none unless the masks of all objects are known
};

SquareScore score_squares(const Recording& recording);

}  // namespace lcs::bench
