/// \file
/// Static points in one frame, and where the truth sees them after any motion of the camera.
///
/// Two kinds: *geometric* ones, a grid over the image at each of some depths, whose truth is the
/// pinhole; and *rendered* ones, the FAST corners of a rendered frame with MuJoCo's depth, whose
/// truth is the simulator's (`sim/truth.h`).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/pose.h"
#include "sim/truth.h"
#include "tools/kinematics/models.h"

namespace lcs::kinematics {

/// A static point, as a frame shows it.
struct Site {
  Vec2 px = Vec2::Zero();
  double depth_m = 0;
};

struct PointSet {
  std::string name;  ///< "geometric" or "rendered"
  sim::Pinhole camera;
  std::vector<Site> sites;
  /// Pixels of the sites in the camera N after a motion, given its pose in C; NaN behind it.
  std::function<std::vector<Vec2>(const sim::Pose& T_CN)> seen_from;
};

/// A grid that reaches into the corners of the image, at each depth.
PointSet geometric_points(const sim::Pinhole& camera, std::span<const double> depths_m,
                          int columns = 21, int rows = 15);

/// The corners of a frame that lie on fixed objects.
PointSet rendered_points(const sim::Pinhole& camera, sim::FrameTruth truth,
                         const std::vector<Eigen::Vector2f>& corners_px);

/// Steps before the experiment over which a landmark learns its ratio, if it was in the image.
inline constexpr int kLearningSteps = 5;

/// Z_ref / Z now of the static point seen at `now_px` that would have been nearest to `before_px`
/// before the camera moved by `displacement_C_m`, not turning. 0 where that shows no parallax.
double ratio_from(const sim::Pinhole& camera, const MotionField& field, const Vec2& now_px,
                  const Vec2& before_px, const Eigen::Vector3d& displacement_C_m);

/// The points that are in the image before and after a motion.
///
/// Each has learnt its depth from the parallax of up to `kLearningSteps` equal steps before, in
/// which the camera did not turn, and corners were seen in whole pixels, as FAST gives them. A
/// point that was out of the image before has the ratio 1, that of Z_ref.
std::vector<Landmark> landmarks(const PointSet& points, const sim::Pose& T_CN,
                                const FieldParameters& field);

/// The exact motion to a camera at `T_CN`.
Step step_to(const sim::Pinhole& camera, const sim::Pose& T_CN, double dt_s,
             const FieldParameters& field);

/// The pose after turning about an axis of the camera (0: x, tilt; 1: y, pan; 2: z, roll) and
/// moving by `displacement_C_m`.
sim::Pose turned(int axis, double angle_rad,
                 const Eigen::Vector3d& displacement_C_m = Eigen::Vector3d::Zero());

}  // namespace lcs::kinematics
