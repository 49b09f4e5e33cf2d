/// \file
/// The step of a corner in a frame, beside the steps that a static point may make.
#pragma once

#include "filter/edges/static_point.h"

namespace lcs {

/// A step without its rotation. Those of static points form a segment, from the farthest to the
/// nearest depth.
struct Step {
  double segment_px = 0;  ///< length of the segment
  double along_px = 0;    ///< of the step, from the segment's far end
  double across_px = 0;
  double farthest_px = 0;  ///< step of a point at the segment's far end

  /// \param parallax_px_m of a static point, over its inverse depth (`parallax_px_m`).
  Step(const Vec2& step_px, const Vec2& parallax_px_m, const DepthBounds& bounds);

  /// Density of the step of a moving point, each order of magnitude of its speed being equally
  /// likely, 1/px^2 (MODEL.md (13)).
  /// \param reach_px the largest step.
  /// \param noise2_px2 of one end, on an axis.
  double density_of_mover(double reach_px, double noise2_px2) const;

  /// Density of the step of a crossing, where the outline of a near body meets an edge behind it,
  /// 1/px^2 (MODEL.md (34)). A crossing slides along the outline.
  /// \param slide standard deviation of the way off the segment, as a share of the way along it.
  double density_of_crossing(double slide, double step_variance_px2) const;
};

}  // namespace lcs
