/// \file
/// Scores a detector in the frames that somebody labelled.
#pragma once

#include "tools/recording/recording.h"

namespace lcs::bench {

/// Over the labelled frames after the warm-up.
struct LabelScore {
  int frames = 0;
  int boxes = 0;        ///< that are not ignored
  int found = 0;        ///< of these, with rebel corners enough in them (`kCornersToFind`)
  int boxed = 0;        ///< of these, matched by a square that moves, at an IoU of 0.5
  int rebels_off = 0;   ///< rebel corners in no box
  int circles_off = 0;  ///< rebel circles with no box under them
};

LabelScore score_labels(const Recording& recording);

}  // namespace lcs::bench
