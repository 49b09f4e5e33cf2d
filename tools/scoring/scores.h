/// \file
/// The counts and samples from which a recording's metrics are computed.
#pragma once

#include <vector>

#include "tools/recording/warnings.h"
#include "tools/scoring/score_labels.h"
#include "tools/scoring/score_rebels.h"
#include "tools/scoring/score_squares.h"

namespace lcs::bench {

struct Scores {
  explicit Scores(const Recording& recording);

  const Recording& recording;
  RebelCornerScore corners;
  RebelObjectScore objects;
  SquareScore squares;
  LabelScore labels;
  std::vector<double> corner_counts;  ///< by frame
  std::vector<double> dimensions;     ///< by frame; empty without layers
  std::vector<double> rotation_errors_mrad, velocity_errors_mps;  ///< of the estimated motion
  std::vector<Warned> warnings;
};

}  // namespace lcs::bench
