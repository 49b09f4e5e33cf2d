/// \file
/// A corner as a static point: its place in the image and its inverse depth, with their covariance.
/// The state (x, y, w), w = 1/Z, goes from frame to frame as the camera's motion says,
///
///   x' = c + (x_r - c - f w_r d_xy) / (1 - w_r d_z),   w' = w_r / (1 - w_r d_z),
///
/// where x_r and w_r = w / (R_3 (h, 1)), h = (x - c) / f, are those after the rotation R, and d the
/// camera's displacement in its own frame, and takes each sighting as an extended Kalman filter
/// does. No point is nearer than z_min, nor behind the ground that is seen there.
#pragma once

#include <Eigen/Core>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"

namespace lcs {

/// 1/Z that a static point may have at a place, 1/m.
struct DepthBounds {
  double least_pm = 0;         ///< as far below the ground as it may have fallen away; 0: infinity
  double most_pm = 0;          ///< at z_min
  double ground_pm = 0;        ///< of the ground as told; 0 above the horizon, or where not known
  double ground_sigma_pm = 0;  ///< standard deviation of that, by its tilt and height

  double half_pm() const { return 0.5 * (most_pm - least_pm); }
};

/// \param x_px of frame k.
DepthBounds depth_bounds(const MotionField& field, const Vec2& x_px);

/// px m: what a static point moves by within a frame, the rotation removed, over its w at the end.
Vec2 parallax_px_m(const Intrinsics& camera, const Eigen::Vector3d& displacement_C_m,
                   const Vec2& rotated_px);

struct StaticPoint {
  Vec2 place_px = Vec2::Zero();
  double inverse_depth_pm = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, w)

  /// Of a point that was seen once, and lies at `rotated_px` after the rotation: where this frame
  /// should show it, at any depth within the bounds. In this frame's w the place is linear,
  ///   x = x_r + w (d_z (x_r - c) - f d_xy),
  /// however far the camera has come. What the velocity may be wrong by is left out, as it grows
  /// with how far the point will have moved.
  /// \param displacement_C_m of the camera since the sighting.
  static StaticPoint seen_once(const Vec2& rotated_px, const Intrinsics& camera,
                               const MotionField& field, const Eigen::Vector3d& displacement_C_m,
                               double noise2_px2);

  /// One frame on.
  /// \param ego_share of the image motion by which the camera's velocity may be wrong.
  StaticPoint predicted(const Intrinsics& camera, const MotionField& field, double ego_share) const;

  /// Updates a predicted point by the sighting.
  /// \return the density of a sighting just there, 1/px^2.
  double see(const Vec2& x_px, double noise2_px2, const DepthBounds& bounds);

  /// Covariance of a sighting about the place, px^2.
  Eigen::Matrix2d spread(double noise2_px2) const;
};

}  // namespace lcs
