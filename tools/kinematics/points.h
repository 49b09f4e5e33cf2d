/// \file
/// Static points in one frame, and their true positions after any motion of the camera.
///
/// Two kinds: *geometric* points, an image grid at each of several depths, whose truth is the
/// pinhole projection; and *rendered* points, the FAST corners of a rendered frame with MuJoCo's
/// depth, whose truth is the simulator's (`sim/truth/truth.h`).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/pose.h"
#include "sim/truth/truth.h"
#include "tools/kinematics/models.h"

namespace lcs::kinematics {

/// A static point in a frame.
struct Site {
  Vec2 px = Vec2::Zero();
  double depth_m = 0;
};

struct PointSet {
  std::string name;  ///< "geometric" or "rendered"
  sim::Pinhole camera;
  std::vector<Site> sites;
  /// Projections of the sites into a camera N after a motion, given its pose in C; NaN behind it.
  std::function<std::vector<Vec2>(const sim::Pose& T_CN)> seen_from;
};

/// A grid over the whole image, up to its corners, at each depth.
PointSet geometric_points(const sim::Pinhole& camera, std::span<const double> depths_m,
                          int columns = 21, int rows = 15);

/// The corners of a frame on fixed objects.
PointSet rendered_points(const sim::Pinhole& camera, sim::FrameTruth truth,
                         const std::vector<Eigen::Vector2f>& corners_px);

/// Steps before the experiment in which a landmark learns its ratio, while it is in the image.
inline constexpr int kLearningSteps = 5;

/// Z_ref / Z at the end of a pure translation by `displacement_C_m`, for the static point at
/// `now_px` whose earlier position is nearest to `before_px`. 0 without parallax.
double ratio_from(const sim::Pinhole& camera, const MotionField& field, const Vec2& now_px,
                  const Vec2& before_px, const Eigen::Vector3d& displacement_C_m);

/// The points that are in the image both before and after a motion.
///
/// Each has learnt its depth from the parallax of up to `kLearningSteps` equal previous steps
/// without rotation, with corners rounded to whole pixels like FAST's. A point that was outside the
/// image before has the ratio 1, that of Z_ref.
std::vector<Landmark> landmarks(const PointSet& points, const sim::Pose& T_CN,
                                const FieldParameters& field);

/// The exact motion to a camera at `T_CN`.
Step step_to(const sim::Pinhole& camera, const sim::Pose& T_CN, double dt_s,
             const FieldParameters& field);

/// The pose after a rotation about an axis of the camera (0: x, tilt; 1: y, pan; 2: z, roll) and a
/// translation by `displacement_C_m`.
sim::Pose turned(int axis, double angle_rad,
                 const Eigen::Vector3d& displacement_C_m = Eigen::Vector3d::Zero());

}  // namespace lcs::kinematics
