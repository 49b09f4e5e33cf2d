#include "filter/kinematics/motion_field.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "filter/kinematics/geometry.h"

namespace lcs {
namespace {

/// First-order displacement of an image point by a small rotation of the camera: the motion field
/// of a rotation, integrated once; px.
/// \param x px, from the principal point. \param w rad, about the camera's axes.
/// \param f focal length, px.
inline Vec2 first_order_rotation(const Vec2& x, const Eigen::Vector3d& w, double f) {
  return {x.x() * x.y() / f * w.x() - (f + x.x() * x.x() / f) * w.y() + x.y() * w.z(),
          (f + x.y() * x.y() / f) * w.x() - x.x() * x.y() / f * w.y() - x.x() * w.z()};
}

/// The same by the paper's first equation as printed, with its errors.
inline Vec2 printed_rotation(const Vec2& x, const Eigen::Vector3d& w, double f) {
  return {f * w.y() + x.y() * w.z() + (x.x() * x.y() * w.x() - x.x() * x.x() * w.y()) / f,
          f * w.x() + x.x() * w.z() + (x.x() * x.y() * w.y() - x.y() * x.y() * w.y()) / f};
}

/// Coordinates beyond the range of int count as infinite.
const double kFarthest_px = std::numeric_limits<int>::max();

}  // namespace

Eigen::Matrix3d rotation_homography(const Intrinsics& camera, const Eigen::Matrix3d& R) {
  Eigen::Matrix3d K;
  K << camera.focal_px, 0, camera.centre_px.x(), 0, camera.focal_px, camera.centre_px.y(), 0, 0, 1;
  return K * R * K.inverse();
}

MotionField::MotionField(const Intrinsics& camera, const EgoMotion& motion,
                         const FieldParameters& parameters)
    : centre_px_(camera.centre_px),
      focal_px_(camera.focal_px),
      dt_s_(motion.dt_s),
      velocity_sigma_mps_(motion.velocity_sigma_mps),
      unseen_turn_rad_(motion.unseen_turn_rad),
      R_cur_prev_(motion.R_cur_prev),
      homography_(rotation_homography(camera, motion.R_cur_prev)),
      w_dt_(motion.w_C_radps * motion.dt_s),
      v_C_mps_(motion.v_C_mps),
      parameters_(parameters),
      ground_(motion.ground),
      moving_(motion.dt_s > 0 && motion.v_C_mps.norm() > parameters.still_speed_mps) {
  if (moving_ && std::abs(v_C_mps_.z()) * kFarthest_px > focal_px_ * v_C_mps_.head<2>().norm()) {
    foe_ = centre_px_ + focal_px_ * v_C_mps_.head<2>() / v_C_mps_.z();
  }
}

MotionField MotionField::corrected(const Eigen::Vector3d& turn_rad,
                                   const Eigen::Vector3d& velocity_mps) const {
  if (!(dt_s_ > 0)) return *this;
  EgoMotion motion;
  motion.dt_s = dt_s_;
  motion.R_cur_prev =
      Eigen::AngleAxisd(-turn_rad.norm(), turn_rad.stableNormalized()) * R_cur_prev_;
  motion.w_C_radps = (w_dt_ + turn_rad) / dt_s_;
  motion.v_C_mps = v_C_mps_ + velocity_mps;
  motion.ground = ground_;
  motion.velocity_sigma_mps = velocity_sigma_mps_;
  motion.unseen_turn_rad = unseen_turn_rad_;
  return MotionField({.focal_px = focal_px_, .centre_px = centre_px_}, motion, parameters_);
}

/// A point turned behind the camera has no image, and the first-order models diverge. Both keep
/// their place.
Vec2 MotionField::rotated(const Vec2& x_px) const {
  const Vec2 x = rotated_unbounded(x_px);
  return x.cwiseAbs().maxCoeff() < kFarthest_px ? x : x_px;
}

Vec2 MotionField::rotated_unbounded(const Vec2& x_px) const {
  switch (parameters_.rotation) {
    case RotationModel::first_order:
      return x_px + first_order_rotation(x_px - centre_px_, w_dt_, focal_px_);
    case RotationModel::as_printed:
      return x_px + printed_rotation(x_px - centre_px_, w_dt_, focal_px_);
    case RotationModel::homography:
      break;
  }
  const Eigen::Vector3d h = homography_ * x_px.homogeneous();
  return h.z() > 1e-6 ? Vec2(h.hnormalized()) : x_px;
}

double MotionField::turned(double angle_rad, const Vec2& location_px, const Vec2& origin_px) const {
  const Vec2 before = location_px - origin_px;
  const Vec2 after = rotated(location_px) - rotated(origin_px);
  if (before.isZero() || after.isZero()) return angle_rad;
  return wrap_angle(angle_rad + angle_of(after) - angle_of(before));
}

Vec2 MotionField::flow(const Vec2& x_px) const {
  if (!moving_) return Vec2::Zero();
  return v_C_mps_.z() * (x_px - centre_px_) - focal_px_ * v_C_mps_.head<2>();
}

Vec2 MotionField::direction(const Vec2& x_px) const {
  const Vec2 g = flow(x_px);
  const double length = g.norm();
  return length > 1e-9 ? Vec2(g / length) : Vec2::Zero();
}

Vec2 MotionField::earlier(const Vec2& x_px, double depth_ratio,
                          const Eigen::Vector3d& displacement_C_m) const {
  const double w = depth_ratio / parameters_.reference_depth_m;  // 1 / Z
  const Eigen::Vector3d h((x_px.x() - centre_px_.x()) / focal_px_ + w * displacement_C_m.x(),
                          (x_px.y() - centre_px_.y()) / focal_px_ + w * displacement_C_m.y(),
                          1 + w * displacement_C_m.z());
  // In reverse a near point may have been behind the camera: then it had no image.
  if (h.z() < 1e-3) return Vec2::Constant(-1e6);
  return centre_px_ + focal_px_ * h.head<2>() / h.z();
}

std::optional<double> MotionField::ground_ratio(const Vec2& x_px) const {
  if (!ground_) return std::nullopt;
  return parameters_.reference_depth_m * ground_->inverse_depth_pm((x_px - centre_px_) / focal_px_);
}

double MotionField::advanced_ratio(double depth_ratio) const {
  const double shrink = 1 - depth_ratio * v_C_mps_.z() * dt_s_ / parameters_.reference_depth_m;
  return shrink > 0 ? std::min(depth_ratio / shrink, 2 * max_ratio()) : 2 * max_ratio();
}

Vec2 MotionField::origin(const Vec2& x_px) const {
  if (foe_) return *foe_;
  if (!moving_) return centre_px_;
  return x_px - direction(x_px) * kFarthest_px;
}

}  // namespace lcs
