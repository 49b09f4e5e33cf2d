/// \file
/// A filter's result for one frame.
#pragma once

#include <optional>
#include <vector>

#include "filter/types/gap.h"
#include "filter/types/layers.h"
#include "filter/types/paper_layers.h"
#include "filter/types/reason.h"

namespace lcs {

/// Wall time of each expert in a frame, ms. For reports only: no filter reads it.
struct StageTimes {
  double line_ms = 0;
  double circle_ms = 0;
  double square_ms = 0;
};

/// A corner, as an index in the caller's list, and the log odds that it moves by itself.
struct CornerOdds {
  int corner;
  float log_odds;
};

struct FrameResult {
  Layers layers;
  PaperLayers paper;              ///< empty in the default filter
  std::vector<Verdict> verdicts;  ///< one for each corner, in the caller's order
  std::vector<Reason> reasons;    ///< of each verdict; empty if the detector gives none
  /// Of each corner: log odds that it moves by itself, 0 if nothing is known; empty if the detector
  /// gives none.
  std::vector<float> log_odds;
  StageTimes times;
  /// The gaps that the filter has asked for, with the answers; absent without a `GapView`.
  std::optional<std::vector<GapSeen>> gaps;
};

}  // namespace lcs
