/// \file
/// A corner as a point that moves by itself: where it is seen and how fast it goes in the image,
/// the camera's rotation removed. Both axes are alike and share one covariance.
#pragma once

#include <Eigen/Core>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"

namespace lcs {

struct OwnMotion {
  Vec2 place_px = Vec2::Zero();
  Vec2 velocity_pxps = Vec2::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (x, v), the same on either axis

  /// Of two sightings, the former one in this frame's pixels.
  static OwnMotion first(const Vec2& before_px, const Vec2& x_px, double noise2_px2, double dt_s);

  /// One frame on.
  /// \param acceleration 1/s: share of the velocity by which it may change in a second.
  OwnMotion predicted(const MotionField& field, double acceleration) const;

  /// Updates a predicted motion by the sighting.
  void see(const Vec2& x_px, double noise2_px2);

  /// Density of a sighting at `x_px` of a predicted motion, 1/px^2.
  double density(const Vec2& x_px, double noise2_px2) const;

  /// Variance of a frame's step on one axis, px^2.
  double step_variance_px2(double dt_s) const { return covariance(1, 1) * dt_s * dt_s; }
};

}  // namespace lcs
