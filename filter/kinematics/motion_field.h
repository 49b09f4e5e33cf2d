/// \file
/// Motion field of the static world in the image of a moving camera (Longuet-Higgins & Prazdny
/// 1980; the paper's section "Kinematics", corrected).
///
/// With x measured from the principal point, camera velocity v, body rate w and depth Z,
///   xdot = (x v_z - f v_x)/Z + (x y/f) w_x - (f + x^2/f) w_y + y w_z
///   ydot = (y v_z - f v_y)/Z + (f + y^2/f) w_x - (x y/f) w_y - x w_z
/// The rotation part needs no depth. The translation part is g(x)/Z with g(x) = v_z (x - c) - f
/// v_xy. It points away from the focus of expansion (FOE) c + f v_xy / v_z, or towards it in
/// reverse. It is parallel when v_z = 0, and zero when the camera stands still.
#pragma once

#include <optional>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"

namespace lcs {

/// Model that rotates stored image locations with the camera (`motion_field.cpp`).
enum class RotationModel {
  first_order,  ///< the motion field of the rotation, integrated once: for small rotations
  homography,   ///< x' ~ K dR K^-1 x, exact
  as_printed,   ///< the paper's first equation with its wrong terms, for comparison
};

struct FieldParameters {
  RotationModel rotation = RotationModel::homography;
  /// Z_ref, m: V_v(x) is the image speed of a static point at this depth. Only a unit of depth:
  /// verdicts do not depend on it.
  double reference_depth_m = 3;
  double nearest_depth_m = 0.4;    ///< z_min: the least depth of a static point
  double still_speed_mps = 0.005;  ///< below it the camera counts as still: no field
};

/// K R K^-1: maps a pixel to its place after the camera coordinates are rotated by R.
Eigen::Matrix3d rotation_homography(const Intrinsics& camera, const Eigen::Matrix3d& R);

/// The motion field over one interval, from frame k-1 to k.
class MotionField {
 public:
  MotionField(const Intrinsics& camera, const EgoMotion& motion, const FieldParameters& parameters);

  /// The field of this motion plus a small rotation and a change of velocity, both along the axes
  /// of the camera at k. Unchanged if no time passed.
  MotionField corrected(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& velocity_mps) const;

  double dt_s() const { return dt_s_; }
  /// From the given `EgoMotion`.
  double velocity_sigma_mps() const { return velocity_sigma_mps_; }
  double unseen_turn_rad() const { return unseen_turn_rad_; }

  /// Place of a location of frame k-1 after the rotation alone, px. All stored locations are
  /// rotated first.
  Vec2 rotated(const Vec2& x_px) const;

  /// K dR K^-1, by which `rotated` maps pixels; absent for the other models of rotation.
  std::optional<Eigen::Matrix3d> homography() const {
    if (parameters_.rotation != RotationModel::homography) return std::nullopt;
    return homography_;
  }

  /// Rotates a direction of motion beta by the rotation of the line from `origin` to `location`;
  /// both are given before the rotation.
  double turned(double angle_rad, const Vec2& location_px, const Vec2& origin_px) const;

  /// False while the camera stands still; the flow then has no direction.
  bool moving() const { return moving_; }

  /// Unit vector of the flow at a rotated location; null while still, or on the FOE itself.
  Vec2 direction(const Vec2& x_px) const;

  /// V_v(x) = |g(x)| / Z_ref, px/s: image speed of a static point at the reference depth.
  double reference_speed(const Vec2& x_px) const {
    return flow(x_px).norm() / parameters_.reference_depth_m;
  }

  /// Place of a static point after the translation, px, from its rotated location and Z_ref / Z at
  /// the interval's end. Exact: includes the change of depth.
  Vec2 translated(const Vec2& rotated_px, double depth_ratio) const {
    return rotated_px + flow(rotated_px) * (depth_ratio * dt_s_ / parameters_.reference_depth_m);
  }

  /// Earlier place of a static point that is now at `x_px`, rotation removed, before the camera
  /// moved by `displacement_C_m`; `depth_ratio` is Z_ref / Z now. Far outside if behind the camera.
  Vec2 earlier(const Vec2& x_px, double depth_ratio, const Eigen::Vector3d& displacement_C_m) const;

  /// Rotates camera coordinates from frame k-1 to frame k.
  const Eigen::Matrix3d& R_cur_prev() const { return R_cur_prev_; }

  double reference_depth_m() const { return parameters_.reference_depth_m; }

  /// m: displacement of the camera over the interval, in the camera frame of k.
  Eigen::Vector3d displacement_C_m() const { return v_C_mps_ * dt_s_; }

  /// px m: image motion of a static point at a rotated location over the interval, over its final
  /// inverse depth.
  Vec2 parallax_px_m(const Vec2& x_px) const { return flow(x_px) * dt_s_; }

  /// Z_ref / Z at the interval's end, from its value at the start. A point that the camera passes
  /// within the interval gets `max_ratio`.
  double advanced_ratio(double depth_ratio) const;

  /// Growth of a patch with this `depth_ratio` at the interval's end: Z(k-1) / Z(k).
  double expansion(double depth_ratio) const {
    return 1 + depth_ratio * v_C_mps_.z() * dt_s_ / parameters_.reference_depth_m;
  }

  /// Z_ref / Z of the ground at a place: lower bound for a static point there. Negative above the
  /// horizon; absent if the ground is unknown.
  std::optional<double> ground_ratio(const Vec2& x_px) const;

  /// Standard deviation of Z_ref / Z of the ground, by its tilt.
  double ground_slack() const {
    constexpr double kTilt_rad = 0.015;  // of the road's surface against the ground plane
    return ground_ ? parameters_.reference_depth_m * kTilt_rad / ground_->height_m : 0;
  }

  /// Absent if unknown.
  const std::optional<Ground>& ground() const { return ground_; }

  /// Largest Z_ref / Z of a static point: at the nearest plausible depth.
  double max_ratio() const { return parameters_.reference_depth_m / parameters_.nearest_depth_m; }

  /// Point from which the flow comes: the FOE. If that is at infinity, a far point behind along the
  /// flow, so that directions and homotheties about it stay valid. The principal point while still.
  Vec2 origin(const Vec2& x_px) const;

  /// The paper's O_I in general; absent while still or moving sideways.
  std::optional<Vec2> foe() const { return foe_; }

 private:
  Vec2 rotated_unbounded(const Vec2& x_px) const;

  /// g(x), px m/s: the flow times the depth.
  Vec2 flow(const Vec2& x_px) const;

  Vec2 centre_px_;
  double focal_px_;
  double dt_s_, velocity_sigma_mps_, unseen_turn_rad_;
  Eigen::Matrix3d R_cur_prev_;
  Eigen::Matrix3d homography_;  // K dR K^-1
  Eigen::Vector3d w_dt_;        // rotation over the interval, rad
  Eigen::Vector3d v_C_mps_;
  FieldParameters parameters_;
  std::optional<Ground> ground_;
  bool moving_;
  std::optional<Vec2> foe_;
};

}  // namespace lcs
