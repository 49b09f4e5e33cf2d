/// \file
/// A track in plain numbers of double precision, one at a time: what the loops over columns of
/// tracks (`filter/edges/track_loops.h`) are compared with.
///
/// A static point is an extended Kalman filter of the state (x, y, w), w = 1/Z, predicted by the
/// camera's motion:
///
///   x' = c + (x_r - c - f w_r d_xy) / (1 - w_r d_z),   w' = w_r / (1 - w_r d_z),
///
/// where x_r and w_r = w / (R_3 (h, 1)), h = (x - c) / f, are the state after the rotation R, and d
/// is the camera's displacement in its own frame. No point is nearer than z_min, or farther than
/// the ground at its place.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "filter/edges/edge_parameters.h"
#include "filter/edges/gauss.h"
#include "filter/edges/motion_fix.h"
#include "filter/edges/tracks.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"
#include "filter/types/layers.h"
#include "filter/types/signature.h"

namespace lcs::testing {

/// Normal densities in the plane, 1/px^2.
inline double gauss(const Vec2& residual, double variance) {
  return std::exp(-0.5 * residual.squaredNorm() / variance) / (2 * std::numbers::pi * variance);
}

inline double gauss(const Vec2& residual, const Eigen::Matrix2d& covariance) {
  return std::exp(-0.5 * distance2(residual, covariance)) /
         (2 * std::numbers::pi * std::sqrt(covariance.determinant()));
}

/// Probability that a standard normal variable is below z.
inline double below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

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

struct Track {
  Vec2 place_px = Vec2::Zero();  ///< last sighting; in a prediction rotated to this frame
  Signature signature{};
  StaticPoint as_static;  ///< of a track seen once: set in predictions only
  OwnMotion as_moving;    ///< from the second sighting on
  int sightings = 0;
  /// Time since the last sighting, and displacement since then in the camera's present frame.
  double since_s = 0;
  Eigen::Vector3d displacement_C_m = Eigen::Vector3d::Zero();
  double log_odds = 0;  ///< of moving, by its own sightings
  double noise_sum_px2 = 0, noise_weight = 0;
  double belief = 0;  ///< log odds of moving, coupled with its neighbours

  bool has_motion() const { return sightings >= 2; }
};

/// Noise of corners on an axis, px^2.
struct Noise {
  double last_px2, now_px2;
};

/// The track in the next frame.
Track predicted(const Track& track, const Intrinsics& camera, const MotionField& field,
                const EdgeParameters& parameters, const Noise& noise);

/// Densities of a sighting, given the predicted track, and the log odds before it.
struct Densities {
  double still_ppx2, moving_ppx2, log_odds_before;
  StaticPoint seen;  ///< the static point after the sighting
};
/// \param noise2_px2 of the track's corners.
Densities densities_of(const Track& track, const Vec2& x_px, const Intrinsics& camera,
                       const MotionField& field, const EdgeParameters& parameters,
                       double noise2_px2);

/// Updates a predicted track by a sighting.
/// \param chance_ppx2 density of wrong pairs that look as good.
/// \return false if neither hypothesis explains the sighting; the track is then unchanged.
bool see(Track& track, const Vec2& x_px, double chance_ppx2, const Intrinsics& camera,
         const MotionField& field, const EdgeParameters& parameters, const Noise& noise);

/// The log odds of moving that a track shows to its neighbours.
/// \param crowd 1 + the number of tracks near it.
double shown(const Track& track, const Intrinsics& camera, const MotionField& field,
             const EdgeParameters& parameters, double crowd, double noise2_px2);

/// The tracks as columns, and back.
Tracks columns_of(std::span<const Track> tracks);
Track track_of(const Tracks& tracks, std::size_t index);

/// Distance of a corner from the static prediction of its track.
struct Residual {
  Vec2 place_px, off_px;
  Eigen::Matrix2d covariance_px2;  ///< of `off_px`, at the track's depth
  Vec2 by_depth_px;                ///< image shift by half of the range of depths
  double inverse_depth_pm = 0, inverse_depth_variance_pm2 = 0;
  double voice = 1;           ///< weight: tracks of one body are off together
  double stands = 1;          ///< chance that the point is static
  double otherwise_ppx2 = 0;  ///< density of the corner if not static, times 1 - `stands`
};
/// These as columns. \param velocity_variance_m2ps2 of the told velocity, on an axis.
Columns<float, kMissColumns> columns_of(std::span<const Residual> residuals,
                                         const Intrinsics& camera, double dt_s,
                                         double velocity_variance_m2ps2);

}  // namespace lcs::testing
