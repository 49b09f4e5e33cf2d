/// \file
/// The counts and samples from which a run's metrics are computed.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "tools/recording/warnings.h"
#include "tools/scoring/score_labels.h"
#include "tools/scoring/score_rebels.h"
#include "tools/scoring/score_squares.h"

namespace lcs::bench {

struct Scores {
  DetectorInfo detector;
  int frames = 0;
  RebelCornerScore corners;
  RebelObjectScore objects;
  SquareScore squares;
  LabelScore labels;
  bool tells_first_sightings = false;  ///< the reason `first_sighting` occurs
  std::set<int> objects_seen;
  std::int64_t rebels_found = 0, movers_found = 0;  ///< right or wrong, over all frames
  std::int64_t edges = 0, rematched_edges = 0;      ///< normal edges, and those of the next frame
  /// \name A number for each frame.
  ///@{
  std::vector<double> corner_counts;
  std::vector<double> dimensions;                                 ///< empty without layers
  std::vector<double> rotation_errors_mrad, velocity_errors_mps;  ///< of the estimated motion
  std::vector<FrameTimes> times;                                  ///< of frames that have them
  ///@}
  std::vector<Warned> warnings;
};

}  // namespace lcs::bench
