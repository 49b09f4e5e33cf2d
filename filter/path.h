/// \file
/// The path of a corner that is taken for a static point, and the depth that it tells: least
/// squares over all of its sightings, none of which is better than another.
///
/// The point is h = (X, Y, Z, 1) / Z in the camera of now: its place in the image and its inverse
/// depth. A sighting (u, v) = (x - c) / f says f (X - u Z) = 0 and f (Y - v Z) = 0, linear in h, in
/// px. Former sightings are kept as a quadratic form h' M h and go from camera to camera with the
/// point, h -> T h, M -> T^-T M T^-1. Where the form is least, with h_z = 1, the point is; its
/// curvature there is the information on the depth, where each sighting errs by 1 px.
///
/// Held to its first sighting, a depth errs with that for ever.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "filter/camera.h"

namespace lcs {

class MotionField;

struct Path {
  /// What a sighting may be off: corners are whole pixels, and not quite where they were.
  static constexpr double kSighting_px = 0.4;

  Vec2 anchor = Vec2::Zero();  ///< first sighting, moved by the rotations since, px
  Eigen::Vector3d travelled_C_m = Eigen::Vector3d::Zero();  ///< by the camera since then
  Eigen::Matrix4d sightings = Eigen::Matrix4d::Zero();      ///< M, px^2
  double ratio = 1;                                         ///< Z_ref / Z
  double weight = 0;  ///< information on the ratio, px^2: (1 px / its standard deviation)^2

  /// Standard deviation of the ratio; infinite where nothing is known.
  double sigma() const { return kSighting_px / std::sqrt(weight); }

  /// The first sighting of a point of which no more than a guess of its depth is known.
  void start(const Vec2& x_px, double depth_ratio, const Intrinsics& camera);

  /// To the camera of the next frame.
  void carry(const MotionField& field);

  /// The point is seen at `x_px`. Sightings without parallax change neither depth nor weight.
  void see(const Vec2& x_px, const Intrinsics& camera, const MotionField& field);
};

}  // namespace lcs
