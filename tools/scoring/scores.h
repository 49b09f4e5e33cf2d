/// \file
/// The counts and samples from which a run's metrics are computed.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "tools/recording/recording.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/score_movers.h"
#include "tools/scoring/score_rebels.h"
#include "tools/scoring/score_squares.h"

namespace lcs::scoring {

/// Counts over the labelled frames after the warm-up.
struct LabelScore {
  int frames = 0;
  int boxes = 0;        ///< labelled boxes, without ignored ones
  int found = 0;        ///< boxes with at least `kCornersToFind` rebel corners in them
  int boxed = 0;        ///< boxes that a moving square matches with an IoU of at least 0.5
  int rebels_off = 0;   ///< rebel corners in no box
  int circles_off = 0;  ///< rebel circles on no box

  void add(const recording::FrameRecord& frame);
};

/// Whether the square moves. A square without circles counts as moving: it is of a user's detector,
/// or of a body that moved before.
bool may_move(const Square& square);

struct Scores {
  recording::DetectorInfo detector;
  int frames = 0;
  RebelCornerScore corners;
  RebelObjectScore objects;
  SquareScore squares;
  MoverScore movers;
  LabelScore labels;
  bool tells_first_sightings = false;  ///< the reason `first_sighting` occurs
  std::set<int> objects_seen;
  std::int64_t rebels_found = 0, movers_found = 0;  ///< right or wrong, over all frames
  std::int64_t edges = 0, rematched_edges = 0;      ///< normal edges; seen in the next frame, too
  /// \name A number for each frame.
  ///@{
  std::vector<double> corner_counts;
  std::vector<double> dimensions;                                 ///< empty without layers
  std::vector<double> rotation_errors_mrad, velocity_errors_mps;  ///< of the estimated motion
  std::vector<recording::FrameTimes> times;                       ///< of frames that have them
  ///@}
  std::vector<recording::Warned> warnings;
};

}  // namespace lcs::scoring
