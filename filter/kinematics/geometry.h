/// \file
/// Angle arithmetic and planar geometry that several experts share.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "filter/kinematics/camera.h"

namespace lcs {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180;

/// Wraps an angle to (-pi, pi].
inline double wrap_angle(double angle_rad) {
  if (std::abs(angle_rad) < kPi) return angle_rad;  // the common case
  const double wrapped = std::remainder(angle_rad, 2 * kPi);
  return wrapped <= -kPi ? wrapped + 2 * kPi : wrapped;
}

/// |a - b| on the circle, in [0, pi].
inline double angle_between(double a_rad, double b_rad) {
  return std::abs(wrap_angle(a_rad - b_rad));
}

/// Direction of a vector; 0 for the null vector.
inline double angle_of(const Vec2& v) {
  return std::atan2(v.y(), v.x());
}

inline Vec2 unit_vector(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Distance of `x` from the segment a-b.
inline double distance_to_segment(const Vec2& x, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((x - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (x - (a + t * ab)).norm();
}

}  // namespace lcs
