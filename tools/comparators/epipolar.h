/// \file
/// The epipolar segment: possible places of a static point in an earlier picture, from the nearest
/// to the farthest depth. The farthest is infinity or, below the horizon with a known ground, the
/// ground's depth on the corner's ray.
#pragma once

#include "filter/kinematics/motion_field.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

/// Largest distance of a static corner from the segment.
inline constexpr double kStatic_px = 0.85;

/// Motion field over an interval, with exact rotation and the filter's default bounds of depth:
/// z_min, and the ground with its slack.
MotionField exact_field(const Intrinsics& camera, const EgoMotion& motion);

/// The inverse of a motion's rotation, without translation: its `exact_field` rotates a location of
/// this frame to the earlier one.
EgoMotion turned_back(const EgoMotion& motion);

/// px: distance of a corner's earlier place (rotation removed) from the epipolar segment.
double epipolar_distance(const MotionField& field, const Vec2& now_px, const Vec2& before_px);

/// Motion of a corner that was at `before_px`, rotation removed. It is off if its distance from the
/// segment exceeds `residual_px`.
CornerMotion epipolar_motion(const MotionField& field, double residual_px, const Vec2& now_px,
                             const Vec2& before_px);

}  // namespace lcs::comparators
