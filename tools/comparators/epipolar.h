/// \file
/// Where a static point may have been in an earlier picture: on the epipolar segment, its images at
/// every depth from the nearest to the farthest. The farthest is infinity or, where the ground is
/// known and the corner lies below the horizon, where its ray meets the ground.
#pragma once

#include "filter/kinematics/motion_field.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

/// Distance from the segment that a static corner may have.
inline constexpr double kStatic_px = 0.85;

/// The field over an interval, with the exact rotation and with the filter's own bounds on depth:
/// z_min, and the ground with its slack.
MotionField exact_field(const Intrinsics& camera, const EgoMotion& motion);

/// The rotation of a motion alone, turned round: its `exact_field` takes a location in this frame
/// to where it lies in the earlier one.
EgoMotion turned_back(const EgoMotion& motion);

/// Distance from where a corner was (rotation removed) to where a static point could have been.
double epipolar_distance(const MotionField& field, const Vec2& now_px, const Vec2& before_px);

/// How a corner moved that was at `before_px`, rotation removed: off, if that is more than
/// `residual_px` off the segment.
CornerMotion epipolar_motion(const MotionField& field, double residual_px, const Vec2& now_px,
                             const Vec2& before_px);

}  // namespace lcs::comparators
