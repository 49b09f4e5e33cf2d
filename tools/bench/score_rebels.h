/// \file
/// How well rebels were told from the static world: corner by corner, and object by object.
#pragma once

#include <vector>

#include "tools/bench/recording.h"
#include "tools/bench/scoring.h"

namespace lcs::bench {

struct RebelCornerScore {
  RebelCounts overall;
  RebelCounts distinct;   ///< radial corners left out
  RebelCounts radial;     ///< radial corners alone (they have no false rebels)
  int fixed_corners = 0;  ///< after the warm-up

  RebelCornerScore& operator+=(const RebelCornerScore& other);
};

/// Counts of each frame, in order; all 0 during the warm-up.
std::vector<RebelCornerScore> score_rebel_corners(const Recording& recording);

struct RebelObjectScore {
  int objects = 0;  ///< distinct in at least N frames
  int found = 0;
  std::vector<double> latencies;  ///< frames from the first distinct one, of each that was found
  int false_circles = 0;          ///< rebel circles with no moving object under them
  int frames = 0;                 ///< in which false circles were looked for
};

RebelObjectScore score_rebel_objects(const Recording& recording);

}  // namespace lcs::bench
