/// \file
/// How the image of the static world moves while the camera does: the motion field
/// (Longuet-Higgins & Prazdny 1980; the paper's section "Kinematics", corrected).
///
/// With x measured from the principal point, camera velocity v, body rate w and depth Z,
///   xdot = (x v_z - f v_x)/Z + (x y/f) w_x - (f + x^2/f) w_y + y w_z
///   ydot = (y v_z - f v_y)/Z + (f + y^2/f) w_x - (x y/f) w_y - x w_z
/// The rotation part needs no depth. The translation part is g(x)/Z with g(x) = v_z (x - c) - f
/// v_xy: it points away from the focus of expansion (FOE) c + f v_xy / v_z, towards it in reverse,
/// is parallel when v_z = 0, and absent when the camera stands still.
#pragma once

#include <optional>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"

namespace lcs {

/// How stored locations follow the rotation of the camera (`rotation_models.h`).
enum class RotationModel {
  first_order,  ///< the motion field of the rotation, integrated once: for small rotations
  homography,   ///< x' ~ K dR K^-1 x, exact
  as_printed,   ///< the paper's first equation with its wrong terms, for comparison
};

struct FieldParameters {
  RotationModel rotation = RotationModel::homography;
  /// Z_ref: V_v(x) is the image speed of a static point at this depth. A unit of depth: results do
  /// not depend on it.
  double reference_depth_m = 3;
  double nearest_depth_m = 0.4;    ///< z_min: the least depth of a static point
  double still_speed_mps = 0.005;  ///< below it the camera stands still: there is no field
};

/// K R K^-1: takes a pixel of a camera to where it lies once the camera's coordinates are turned by
/// R.
Eigen::Matrix3d rotation_homography(const Intrinsics& camera, const Eigen::Matrix3d& R);

/// The field over one interval, from frame k-1 to k.
class MotionField {
 public:
  MotionField(const Intrinsics& camera, const EgoMotion& motion, const FieldParameters& parameters);

  /// The field of this motion followed by a small turn of the camera, and of another velocity, m/s
  /// more along each axis of the camera at k. The same where no time passed.
  MotionField corrected(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& velocity_mps) const;

  double dt_s() const { return dt_s_; }
  /// As told (`EgoMotion`).
  double velocity_sigma_mps() const { return velocity_sigma_mps_; }
  double unseen_turn_rad() const { return unseen_turn_rad_; }

  /// Where a location of frame k-1 lies after the rotation alone: what every stored location is
  /// moved by first.
  Vec2 rotated(const Vec2& x_px) const;

  /// A direction of motion beta after the rotation: turned by as much as the line from `origin` to
  /// `location`, both before the rotation.
  double turned(double angle_rad, const Vec2& location_px, const Vec2& origin_px) const;

  /// False while the camera stands still: there is no direction of flow then.
  bool moving() const { return moving_; }

  /// Unit vector of the flow at a rotated location; null while still, or on the FOE itself.
  Vec2 direction(const Vec2& x_px) const;

  /// V_v(x) = |g(x)| / Z_ref, px/s: image speed of a static point at the reference depth.
  double reference_speed(const Vec2& x_px) const {
    return flow(x_px).norm() / parameters_.reference_depth_m;
  }

  /// Where a static point comes to, given its rotated location and, at the end of the interval,
  /// Z_ref / Z. Exact: the depth's own change is in it.
  Vec2 translated(const Vec2& rotated_px, double depth_ratio) const {
    return rotated_px + flow(rotated_px) * (depth_ratio * dt_s_ / parameters_.reference_depth_m);
  }

  /// Where a static point that is seen at `x_px` now was seen (rotation removed) before the camera
  /// moved by `displacement_C_m`, given Z_ref / Z now.
  Vec2 earlier(const Vec2& x_px, double depth_ratio, const Eigen::Vector3d& displacement_C_m) const;

  /// Takes camera coordinates of frame k-1 to those of frame k.
  const Eigen::Matrix3d& R_cur_prev() const { return R_cur_prev_; }

  double reference_depth_m() const { return parameters_.reference_depth_m; }

  /// Of the camera over the interval, in the camera frame of k.
  Eigen::Vector3d displacement_C_m() const { return v_C_mps_ * dt_s_; }

  /// Z_ref / Z at the end of the interval from the one at its start. A point that the camera passes
  /// within the interval gets the largest plausible ratio.
  double advanced_ratio(double depth_ratio) const;

  /// By how much a patch grows that is at `depth_ratio` at the end of the interval: Z(k-1) / Z(k).
  double expansion(double depth_ratio) const {
    return 1 + depth_ratio * v_C_mps_.z() * dt_s_ / parameters_.reference_depth_m;
  }

  /// Z_ref / Z of the ground seen at a place: the least that a static point may have there.
  /// Negative above the horizon; none where the ground is not known.
  std::optional<double> ground_ratio(const Vec2& x_px) const;

  /// Z_ref / Z by which the ground may differ from its plane.
  double ground_slack() const {
    constexpr double kTilt_rad = 0.015;  // of a road's surface against the plane under the vehicle
    return ground_ ? parameters_.reference_depth_m * kTilt_rad / ground_->height_m : 0;
  }

  /// Absent where it is not known.
  const std::optional<Ground>& ground() const { return ground_; }

  /// Largest Z_ref / Z of a static point: at the nearest plausible depth.
  double max_ratio() const { return parameters_.reference_depth_m / parameters_.nearest_depth_m; }

  /// Point that the flow is seen to come from: the FOE, or, where that is at infinity, a point far
  /// behind along the flow, so that directions and homotheties about it stay what they should be.
  /// The principal point while still.
  Vec2 origin(const Vec2& x_px) const;

  /// The paper's O_I in general; none while still or moving sideways.
  std::optional<Vec2> foe() const { return foe_; }

 private:
  Vec2 rotated_unbounded(const Vec2& x_px) const;

  /// g(x), m/s * px: the flow times the depth.
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
