/// \file
/// The strip of the picture between the foot of a circle and the ground on which it would stand.
/// The filter asks what is seen there; a picture (`detect/gap_picture.h`) or a recording answers.
#pragma once

#include <optional>

#include "filter/kinematics/ego_motion.h"
#include "filter/types/layers.h"

namespace lcs {

/// A grid of places, a pixel apart, along and across the ground's direction upwards in the picture.
struct Gap {
  Id circle = 0;
  Vec2 place_px = Vec2::Zero();  ///< first place of the first row: its highest one
  Vec2 across = Vec2::UnitX();   ///< unit vector of a row
  int columns = 0, rows = 0;
  double inverse_depth_pm = 0;  ///< of the circle

  Vec2 at(int column, int row) const {
    return place_px + column * across + row * Vec2(-across.y(), across.x());
  }
};

/// A gap and the answer.
struct GapSeen {
  Gap gap;
  double evidence = 0;
};

/// Looks at gaps of the current frame.
class GapView {
 public:
  virtual ~GapView() = default;

  /// Begins a frame. \param motion since the last frame, which may have no time (`dt_s` 0): then
  ///   nothing is known of earlier frames. Its ground, if any, is the ground of later gaps.
  virtual void begin(const EgoMotion& motion) = 0;

  /// Log likelihood ratio: the gap shows the ground or nothing / it shows the circle's body.
  /// Absent if the gap is too small or no earlier frame is known.
  virtual std::optional<double> evidence(const Gap& gap) = 0;
};

}  // namespace lcs
