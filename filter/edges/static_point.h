/// \file
/// A track as a static point: place in the image and inverse depth, with their covariance. An
/// extended Kalman filter predicts the state (x, y, w), w = 1/Z, by the camera's motion:
///
///   x' = c + (x_r - c - f w_r d_xy) / (1 - w_r d_z),   w' = w_r / (1 - w_r d_z),
///
/// where x_r and w_r = w / (R_3 (h, 1)), h = (x - c) / f, are the state after the rotation R, and d
/// is the camera's displacement in its own frame. No point is nearer than z_min, or farther than
/// the ground at its place.
#pragma once

#include <Eigen/Core>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"

namespace lcs {

/// Bounds of 1/Z of a static point at a place, 1/m.
struct DepthBounds {
  double least_pm = 0;         ///< with a margin below the ground; 0: infinity
  double most_pm = 0;          ///< at z_min
  double ground_pm = 0;        ///< of the given ground; 0 above the horizon or if unknown
  double ground_sigma_pm = 0;  ///< standard deviation of the ground, by tilt and height

  double half_pm() const { return 0.5 * (most_pm - least_pm); }
};

/// \param x_px of frame k.
DepthBounds depth_bounds(const MotionField& field, const Vec2& x_px);

/// px m: image motion of a static point in a frame, rotation removed, over its final w.
Vec2 parallax_px_m(const Intrinsics& camera, const Eigen::Vector3d& displacement_C_m,
                   const Vec2& rotated_px);

struct StaticPoint {
  Vec2 place_px = Vec2::Zero();
  double inverse_depth_pm = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, w)

  /// A point with one sighting, at `rotated_px` after the rotation, predicted to this frame at any
  /// depth within the bounds. Its place is linear in w of this frame:
  ///   x = x_r + w (d_z (x_r - c) - f d_xy).
  /// Omits the error of the velocity: it depends on the image motion, unknown before the sighting.
  /// \param displacement_C_m of the camera since the sighting.
  static StaticPoint seen_once(const Vec2& rotated_px, const Intrinsics& camera,
                               const MotionField& field, const Eigen::Vector3d& displacement_C_m,
                               double noise2_px2);

  /// Predicts it to the next frame.
  /// \param ego_share relative error of the camera's velocity, and so of the image motion.
  StaticPoint predicted(const Intrinsics& camera, const MotionField& field, double ego_share) const;

  /// The rotated place of a point, and derivatives of its prediction: F = [a I, b; 0, c].
  struct Step {
    Vec2 rotated_px;
    double a;
    Vec2 b;
    double c;
  };
  /// Predicts place and inverse depth from a point of the last frame, by a motion.
  Step move(const StaticPoint& before, const Intrinsics& camera, const MotionField& field);

  /// Updates a predicted point by a sighting, and clamps its depth to the bounds.
  /// \return the density of the sighting, given the prediction, 1/px^2.
  double update(const Vec2& x_px, double noise2_px2, const DepthBounds& bounds);

  /// Covariance of a sighting, given the prediction, px^2.
  Eigen::Matrix2d spread(double noise2_px2) const;
};

}  // namespace lcs
