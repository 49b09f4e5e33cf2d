/// \file
/// Static points in one frame, and their true positions after any motion of the camera.
///
/// Two kinds: *geometric* points, an image grid at each of several depths, whose truth is the
/// pinhole projection; and *rendered* points, the FAST corners of a rendered frame with MuJoCo's
/// depth, whose truth is the simulator's (`sim/truth/truth.h`).
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "sim/base/pose.h"
#include "sim/truth/truth.h"

namespace lcs::kinematics {

// ---- The nine models that are compared with the truth: three rotations, each with three sources
// of a landmark's depth. All of them are the filter's code (`filter/kinematics/motion_field.h`).

/// Source of the ratio Z_ref / Z, and so of the image speed V = V_v Z_ref / Z.
enum class DepthSource {
  reference,  ///< none: V = V_v, as if all points were at Z_ref
  learnt,     ///< the landmark's own motion up to frame k-1
  truth,      ///< the true depth
};

struct FieldModel {
  RotationModel rotation = RotationModel::homography;
  DepthSource depth = DepthSource::truth;
};

inline constexpr std::array kRotations = {RotationModel::as_printed, RotationModel::first_order,
                                          RotationModel::homography};
inline constexpr std::array kDepths = {DepthSource::reference, DepthSource::learnt,
                                       DepthSource::truth};
inline constexpr auto kModels = [] {
  std::array<FieldModel, kRotations.size() * kDepths.size()> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = {kRotations[i / kDepths.size()], kDepths[i % kDepths.size()]};
  }
  return all;
}();

const char* name(RotationModel rotation);
const char* name(DepthSource depth);

/// A static point, seen in frame k-1 and again in frame k. Pixels and frames are as in
/// `filter/kinematics/camera.h`.
struct Landmark {
  Vec2 before_px = Vec2::Zero();  ///< in frame k-1
  Vec2 after_px = Vec2::Zero();   ///< in frame k: the truth
  double depth_after_m = 0;
  double learnt_ratio = 1;  ///< Z_ref / Z in frame k-1, estimated from the earlier motion
};

/// The camera, its motion as given to the model, and the filter's parameters of the field.
struct FieldStep {
  Intrinsics camera;
  EgoMotion motion;
  FieldParameters field;
};

/// End-point errors, px. Without points all figures are 0.
struct ErrorSummary {
  std::size_t count = 0;
  double median_px = 0;
  double p95_px = 0;
  double max_px = 0;
  double rms_px = 0;
};
ErrorSummary summary(std::vector<double> errors_px);

template <class Value>
void append(std::vector<Value>& all, const std::vector<Value>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// End-point errors, px, of one model on landmarks that share a step.
std::vector<double> errors(const FieldStep& step, const FieldModel& model,
                           const std::vector<Landmark>& landmarks);

// ---- The points

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
/// image before has the ratio 1: its depth is Z_ref.
std::vector<Landmark> landmarks(const PointSet& points, const sim::Pose& T_CN,
                                const FieldParameters& field);

/// The exact motion to a camera at `T_CN`.
FieldStep step_to(const sim::Pinhole& camera, const sim::Pose& T_CN, double dt_s,
                  const FieldParameters& field);

/// The pose after a rotation about an axis of the camera (0: x, tilt; 1: y, pan; 2: z, roll) and a
/// translation by `displacement_C_m`.
sim::Pose turned(int axis, double angle_rad,
                 const Eigen::Vector3d& displacement_C_m = Eigen::Vector3d::Zero());

}  // namespace lcs::kinematics
