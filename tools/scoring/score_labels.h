/// \file
/// Scores a detector on labelled frames.
#pragma once

#include "tools/recording/recording.h"

namespace lcs::bench {

/// Counts over the labelled frames after the warm-up.
struct LabelScore {
  int frames = 0;
  int boxes = 0;        ///< labelled boxes, without ignored ones
  int found = 0;        ///< boxes with at least `kCornersToFind` rebel corners in them
  int boxed = 0;        ///< boxes that a moving square matches with an IoU of at least 0.5
  int rebels_off = 0;   ///< rebel corners in no box
  int circles_off = 0;  ///< rebel circles on no box

  void add(const FrameRecord& frame);
};

/// Whether the square moves. A square without circles, of a user's detector, counts as moving.
bool may_move(const Square& square);

}  // namespace lcs::bench
