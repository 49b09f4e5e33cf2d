/// \file
/// The numbers by which the filter judged a corner, with the equations of MODEL.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "filter/edges/track_loops.h"
#include "filter/types/layers.h"

namespace lcs {

/// What a neighbour told a corner in the last round of (18).
struct Voice {
  int corner;    ///< index in the caller's list
  float weight;  ///< k, (19)
  float said;    ///< tanh(m/2)
};

/// A corner of the last frame.
struct Explanation {
  using State = std::array<float, kTrackColumns>;  ///< of a track, by `TrackColumn`

  Id track = 0;  ///< of the corner, from this frame on
  int age = 0;   ///< frames since its first sighting
  /// The track that the corner was assigned to; 0: none. If it is another one than `track`, the
  /// corner fits neither of its predictions, and it ended (15).
  Id assigned = 0;
  State predicted{};  ///< of `assigned`, in this frame: (1) to (5)
  State seen{};       ///< of `track`, after the sighting: (12) to (18)
  /// px^2: covariance of a sighting of a static point, given the prediction, (12).
  Eigen::Matrix2d static_spread_px2 = Eigen::Matrix2d::Zero();
  float shown = 0;            ///< L_C, (34); 0 for a corner seen once
  std::vector<Voice> voices;  ///< heaviest first; none for a corner seen once

  Vec2 place_px() const { return {seen[kPlaceX], seen[kPlaceY]}; }
  /// A prediction of the place. \param x its first column.
  Vec2 predicted_px(TrackColumn x) const { return {predicted[x], predicted[x + 1]}; }
  /// The distance of the place from a prediction; NaN without the prediction.
  double miss_px(TrackColumn x) const;
};

struct ExplainedNumber {
  const char* equation;        ///< of MODEL.md, such as "(12)"
  const char* name;            ///< with its unit, such as "p_S, 1/px^2"
  std::vector<double> values;  ///< two are x and y
};

/// All numbers of the corner's own that are defined, in the order of the filter's steps.
std::vector<ExplainedNumber> numbers_of(const Explanation& why);

}  // namespace lcs
