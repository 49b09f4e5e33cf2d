/// \file
/// A corner over time under two hypotheses, static and moving by itself, with the log odds of
/// moving.
#pragma once

#include <Eigen/Core>

#include "filter/edges/corner_noise.h"
#include "filter/edges/static_point.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"
#include "filter/types/layers.h"
#include "filter/types/signature.h"

namespace lcs {

/// A track as a point that moves by itself: place and velocity in the image, camera rotation
/// removed. Both axes share one covariance.
struct OwnMotion {
  Vec2 place_px = Vec2::Zero();
  Vec2 velocity_pxps = Vec2::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (x, v), the same on each axis

  /// From two sightings; `before_px` in this frame's pixels.
  static OwnMotion first(const Vec2& before_px, const Vec2& x_px, double noise2_px2, double dt_s);

  /// Its place in the next frame.
  Vec2 moved(const MotionField& field) const {
    return field.rotated(place_px) + velocity_pxps * field.dt_s();
  }
  /// Predicts it to the next frame.
  /// \param acceleration 1/s: relative change of the velocity per second.
  OwnMotion predicted(const MotionField& field, double acceleration) const;

  /// Kalman update by a sighting.
  void update(const Vec2& x_px, double noise2_px2);

  /// Density of a sighting at `x_px`, given the prediction, 1/px^2.
  double density(const Vec2& x_px, double noise2_px2) const;

  /// Variance of a frame's step on one axis, px^2.
  double step_variance_px2(double dt_s) const { return covariance(1, 1) * dt_s * dt_s; }
};

struct Track {
  Id id = 0;
  Vec2 place_px = Vec2::Zero();  ///< last sighting; in a prediction rotated to this frame
  Signature signature{};
  StaticPoint as_static;  ///< of a track seen once: set in predictions only
  OwnMotion as_moving;    ///< from the second sighting on
  int sightings = 0;
  /// Time since the last sighting, and displacement since then in the camera's present frame.
  double since_s = 0;
  Eigen::Vector3d displacement_C_m = Eigen::Vector3d::Zero();
  int age = 0;          ///< frames since the first sighting
  int unseen = 0;       ///< frames since the last sighting
  int corner = -1;      ///< index in this frame, -1: none
  double log_odds = 0;  ///< of moving, by its own sightings
  CornerNoise noise;
  double belief = 0;  ///< log odds of moving, coupled with its neighbours

  bool has_motion() const { return sightings >= 2; }
};

}  // namespace lcs
