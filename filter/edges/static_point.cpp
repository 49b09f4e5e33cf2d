#include "filter/edges/static_point.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "filter/edges/gauss.h"

namespace lcs {
namespace {

/// Relative standard deviation of the given height above the ground.
constexpr double kWrongHeight = 0.1;
/// No static point lies more than this many standard deviations below the ground.
constexpr double kFarBelow = 2;

/// Probability of a normal variable between the bounds; never 0, as it is a divisor.
double mass(double mean, double variance, const DepthBounds& bounds) {
  const double sigma = std::sqrt(variance);
  // Infinite depth (w = 0) is a sharp bound, the ground an uncertain one.
  const double least = std::max(
      -mean / sigma, (bounds.ground_pm - mean) / Vec2(sigma, bounds.ground_sigma_pm).norm());
  return std::max(1e-12, below((bounds.most_pm - mean) / sigma) - below(least));
}

/// 1/z_min.
double nearest_pm(const MotionField& field) {
  return field.max_ratio() / field.reference_depth_m();
}

/// Covariance of an image motion under a relative error of the velocity: the error along the
/// motion, half of it across.
Eigen::Matrix2d wrong_flow(const Vec2& flow_px, double ego_share) {
  return ego_share * ego_share *
         (0.75 * flow_px * flow_px.transpose() +
          0.25 * flow_px.squaredNorm() * Eigen::Matrix2d::Identity());
}

}  // namespace

Vec2 parallax_px_m(const Intrinsics& camera, const Eigen::Vector3d& displacement_C_m,
                   const Vec2& rotated_px) {
  return (rotated_px - camera.centre_px) * displacement_C_m.z() -
         camera.focal_px * displacement_C_m.head<2>();
}

DepthBounds depth_bounds(const MotionField& field, const Vec2& x_px) {
  DepthBounds bounds;
  bounds.most_pm = nearest_pm(field);
  const auto ground = field.ground_ratio(x_px);
  if (!ground || *ground <= 0) return bounds;
  bounds.ground_pm = *ground / field.reference_depth_m();
  bounds.ground_sigma_pm =
      Vec2(field.ground_slack() / field.reference_depth_m(), kWrongHeight * bounds.ground_pm)
          .norm();
  bounds.least_pm =
      std::clamp(bounds.ground_pm - kFarBelow * bounds.ground_sigma_pm, 0.0, 0.95 * bounds.most_pm);
  return bounds;
}

StaticPoint StaticPoint::seen_once(const Vec2& rotated_px, const Intrinsics& camera,
                                   const MotionField& field,
                                   const Eigen::Vector3d& displacement_C_m, double noise2_px2) {
  const DepthBounds bounds = depth_bounds(field, rotated_px);
  const double half = bounds.half_pm();
  const Vec2 parallax = parallax_px_m(camera, displacement_C_m, rotated_px);
  StaticPoint point;
  point.inverse_depth_pm = bounds.least_pm + half;
  point.place_px = rotated_px + point.inverse_depth_pm * parallax;
  Eigen::Vector3d by_depth;
  by_depth << parallax, 1;
  point.covariance = half * half * by_depth * by_depth.transpose();
  point.covariance.topLeftCorner<2, 2>() += noise2_px2 * Eigen::Matrix2d::Identity();
  return point;
}

StaticPoint::Step StaticPoint::move(const StaticPoint& before, const Intrinsics& camera,
                                    const MotionField& field) {
  const Eigen::Vector3d d = field.displacement_C_m();
  Step step;
  step.rotated_px = field.rotated(before.place_px);
  const Vec2 h = step.rotated_px - camera.centre_px, shift = camera.focal_px * d.head<2>();
  // A point that the camera passes within the frame is put at z_min. A point turned behind the
  // camera has no image and keeps its place and inverse depth.
  const double nearest = nearest_pm(field);
  const Vec2 ray = (before.place_px - camera.centre_px) / camera.focal_px;
  const double Z = field.R_cur_prev().row(2).dot(ray.homogeneous());  // Z after R / Z before
  const double turned = Z > 0 ? std::max(before.inverse_depth_pm / nearest, Z) : 1;
  const double w = before.inverse_depth_pm / turned;
  const double nearing = std::max(w / nearest, 1 - w * d.z());
  place_px = camera.centre_px + (h - w * shift) / nearing;
  inverse_depth_pm = w / nearing;
  step.a = 1 / nearing;
  step.c = step.a * step.a / turned;
  step.b = step.c * (h * d.z() - shift);
  return step;
}

StaticPoint StaticPoint::predicted(const Intrinsics& camera, const MotionField& field,
                                   double ego_share) const {
  StaticPoint next;
  const auto [rotated, a, b, c] = next.move(*this, camera, field);
  // F C F^T, with the derivatives F = [a I, b; 0, c].
  const double C_ww = covariance(2, 2);
  const Vec2 C_xw = covariance.topRightCorner<2, 1>(), next_xw = a * C_xw + C_ww * b;
  next.covariance.topLeftCorner<2, 2>() = a * a * covariance.topLeftCorner<2, 2>() +
                                          a * C_xw * b.transpose() + b * next_xw.transpose() +
                                          wrong_flow(next.place_px - rotated, ego_share);
  next.covariance.topRightCorner<2, 1>() = c * next_xw;
  next.covariance.bottomLeftCorner<1, 2>() = c * next_xw.transpose();
  next.covariance(2, 2) = c * c * C_ww;
  return next;
}

Eigen::Matrix2d StaticPoint::spread(double noise2_px2) const {
  return covariance.topLeftCorner<2, 2>() + noise2_px2 * Eigen::Matrix2d::Identity();
}

double StaticPoint::update(const Vec2& x_px, double noise2_px2, const DepthBounds& bounds) {
  const Eigen::Matrix2d S = spread(noise2_px2);
  const Vec2 residual = x_px - place_px;
  const double before = mass(inverse_depth_pm, covariance(2, 2), bounds);
  const Eigen::Matrix<double, 3, 2> gain = covariance.leftCols<2>() * S.inverse();
  const Eigen::Vector3d change = gain * residual;
  place_px += change.head<2>();
  inverse_depth_pm += change.z();
  // Joseph's form keeps the covariance positive definite.
  Eigen::Matrix3d kept = Eigen::Matrix3d::Identity();
  kept.leftCols<2>() -= gain;
  covariance = kept * covariance * kept.transpose() + noise2_px2 * gain * gain.transpose();
  const double after = mass(inverse_depth_pm, covariance(2, 2), bounds);
  // If w is out of bounds: the likeliest point within them.
  const double bounded = std::clamp(inverse_depth_pm, bounds.least_pm, bounds.most_pm);
  place_px += covariance.col(2).head<2>() / covariance(2, 2) * (bounded - inverse_depth_pm);
  inverse_depth_pm = bounded;
  return gauss(residual, S) * std::min(1.0, after / std::max(1e-6, before));
}

}  // namespace lcs
