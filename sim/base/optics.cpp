#include "sim/base/optics.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace lcs::sim {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// tan(80 deg): a pinhole that sees more is larger than any picture.
constexpr double kMostRadius = 5.67;

std::array<double, 5> five(const std::vector<double>& coefficients) {
  std::array<double, 5> k{};
  std::copy_n(coefficients.begin(), std::min(k.size(), coefficients.size()), k.begin());
  return k;
}

/// theta (1 + k1 theta^2 + ...) and its derivative: Kannala and Brandt, PAMI 2006.
std::array<double, 2> equidistant(const std::vector<double>& coefficients, double theta) {
  const auto k = five(coefficients);
  const double t2 = theta * theta;
  return {theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))),
          1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])))};
}

}  // namespace

Pinhole Pinhole::from_fovy(int width_px, int height_px, double fovy_rad) {
  if (width_px <= 0 || height_px <= 0) {
    throw std::invalid_argument("a camera needs a positive width and height");
  }
  if (!(fovy_rad > 0 && fovy_rad < std::numbers::pi)) {
    throw std::invalid_argument("the vertical field of view must lie between 0 and 180 deg");
  }
  const double focal_px = height_px / 2.0 / std::tan(fovy_rad / 2);
  const Eigen::Vector2d centre_px((width_px - 1) / 2.0, (height_px - 1) / 2.0);
  return {focal_px, centre_px, width_px, height_px};
}

bool Lens::is_pinhole() const {
  const bool is_straight = std::ranges::all_of(coefficients, [](double c) { return c == 0; });
  return fu_px == fv_px && is_straight && distortion != Distortion::equidistant && xi == 0 &&
         alpha == 0;
}

Pinhole Lens::pinhole() const {
  return {0.5 * (fu_px + fv_px) / (1 + xi), {cu_px, cv_px}, width_px, height_px};
}

void set_distortion(const scenario::Distortion& distortion, Lens& lens) {
  lens.distortion =
      distortion.equidistant ? Lens::Distortion::equidistant : Lens::Distortion::radial_tangential;
  lens.coefficients = distortion.coefficients;
}

Lens lens_of(const scenario::Camera& camera) {
  const Pinhole pinhole = Pinhole::from_fovy(camera.width_px, camera.height_px, camera.fovy_rad);
  const Vector2d focal_px = camera.focal_px.value_or(Vector2d::Constant(pinhole.focal_px));
  const Vector2d centre_px = camera.centre_px.value_or(pinhole.centre_px);
  Lens lens{.fu_px = focal_px.x(),
            .fv_px = focal_px.y(),
            .cu_px = centre_px.x(),
            .cv_px = centre_px.y(),
            .coefficients = {},
            .width_px = camera.width_px,
            .height_px = camera.height_px,
            .source = camera.source};
  if (camera.distortion) set_distortion(*camera.distortion, lens);
  return lens;
}

Optics::Optics(const Pinhole& camera)
    : Optics(Lens{.fu_px = camera.focal_px,
                  .fv_px = camera.focal_px,
                  .cu_px = camera.centre_px.x(),
                  .cv_px = camera.centre_px.y(),
                  .coefficients = {},
                  .width_px = camera.width_px,
                  .height_px = camera.height_px}) {}

Optics::Optics(const Lens& lens)
    : lens_(lens), focal_px_(lens.fu_px, lens.fv_px), centre_px_(lens.cu_px, lens.cv_px) {
  if (lens_.is_pinhole()) return;
  constexpr double kStep = 1e-3;
  while (most_radius_ < kMostRadius && grows(most_radius_ + kStep) > 0) most_radius_ += kStep;
  rays_.create(size_px());
  for (int y = 0; y < rays_.rows; ++y) {
    for (int x = 0; x < rays_.cols; ++x) {
      const std::optional<Vector2d> ray = straight({x, y});
      if (!ray) {
        throw input::Error(lens_.source,
                           "camera.distortion: the pixel ({}, {}) has no ray: the distortion turns "
                           "back {:.0f} deg off the axis, or reaches beyond 80 deg; correct the "
                           "coefficients, or make the picture smaller or the focal length longer",
                           x, y, std::atan(most_radius_) * 180 / std::numbers::pi);
      }
      rays_(y, x) = {ray->x(), ray->y()};
    }
  }
}

/// Derivative of the distorted radius by the radius of a ray, without the tangential part.
double Optics::grows(double radius) const {
  if (lens_.distortion == Lens::Distortion::equidistant) {
    return equidistant(lens_.coefficients, std::atan(radius))[1];
  }
  const auto [k1, k2, p1, p2, k3] = five(lens_.coefficients);
  const double r2 = radius * radius;
  return 1 + r2 * (3 * k1 + r2 * (5 * k2 + r2 * 7 * k3));
}

/// The distorted image coordinates of a ray.
Vector2d Optics::bent(const Vector2d& ray) const {
  const double r2 = ray.squaredNorm();
  if (lens_.distortion == Lens::Distortion::equidistant) {
    const double r = std::sqrt(r2);
    return r > 0 ? Vector2d(equidistant(lens_.coefficients, std::atan(r))[0] / r * ray) : ray;
  }
  const auto [k1, k2, p1, p2, k3] = five(lens_.coefficients);
  const double x = ray.x(), y = ray.y();
  return (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) * ray +
         Vector2d(2 * p1 * x * y + p2 * (r2 + 2 * x * x), p1 * (r2 + 2 * y * y) + 2 * p2 * x * y);
}

Matrix2d Optics::jacobian_px(const Vector2d& ray) const {
  Matrix2d J = Matrix2d::Identity();
  const double r2 = ray.squaredNorm();
  const auto [k1, k2, p1, p2, k3] = five(lens_.coefficients);
  if (lens_.distortion == Lens::Distortion::equidistant) {
    const double r = std::sqrt(r2);
    const auto [bent_radius, slope] = equidistant(lens_.coefficients, std::atan(r));
    const double scale = r > 0 ? bent_radius / r : 1;
    // the limit for r -> 0: scale is 1 + (k1 - 1/3) r^2 there
    const double curved =
        r > 1e-4 ? (slope / (1 + r2) - scale) / r2 : 2 * (lens_.coefficients.front() - 1.0 / 3);
    J = scale * Matrix2d::Identity() + curved * ray * ray.transpose();
  } else if (!is_pinhole()) {
    const double a = 1 + r2 * (k1 + r2 * (k2 + r2 * k3)), b = k1 + r2 * (2 * k2 + r2 * 3 * k3);
    const double x = ray.x(), y = ray.y(), xy = 2 * (x * y * b + p1 * x + p2 * y);
    J << a + 2 * x * x * b + 2 * p1 * y + 6 * p2 * x, xy, xy,
        a + 2 * y * y * b + 6 * p1 * y + 2 * p2 * x;
  }
  return focal_px_.asDiagonal() * J;
}

/// Newton's method; absent unless it ends at a ray within the distortion's range.
std::optional<Vector2d> Optics::straight(const Vector2d& px) const {
  constexpr int kMostSteps = 50;
  constexpr double kClose_px = 1e-10;
  const Vector2d goal = (px - centre_px_).cwiseQuotient(focal_px_);
  Vector2d ray = goal;
  if (lens_.distortion == Lens::Distortion::equidistant) {
    // along a meridian, where tan() would lead Newton's method in two dimensions astray
    double theta = std::min(goal.norm(), 1.0);
    for (int i = 0; i < kMostSteps; ++i) {
      const auto [radius, slope] = equidistant(lens_.coefficients, theta);
      const double before = theta;
      theta = std::clamp(theta - (radius - goal.norm()) / slope, 0.0, std::atan(kMostRadius));
      if (std::abs(theta - before) < 1e-15) break;
    }
    if (goal.norm() > 0) ray = std::tan(theta) * goal.normalized();
  } else {
    for (int i = 0; i < kMostSteps; ++i) {
      const Vector2d off_px = focal_px_.cwiseProduct(bent(ray) - goal);
      if (off_px.norm() < kClose_px) break;
      ray -= jacobian_px(ray).inverse() * off_px;
      if (ray.norm() > most_radius_) ray *= most_radius_ / ray.norm();
    }
  }
  constexpr double kFound_px = 1e-6;
  const double off_px = focal_px_.cwiseProduct(bent(ray) - goal).norm();
  if (!(off_px < kFound_px && ray.norm() < most_radius_)) return std::nullopt;
  return ray;
}

Vector2d Optics::project(const Vector3d& x_C) const {
  if (is_pinhole()) {
    return (focal_px_.array() * x_C.head<2>().array() / x_C.z()).matrix() + centre_px_;
  }
  const Vector2d ray = x_C.head<2>() / x_C.z();
  if (!(ray.norm() <= most_radius_)) return Vector2d::Constant(kNan);
  return focal_px_.cwiseProduct(bent(ray)) + centre_px_;
}

Vector3d Optics::back_project(const Vector2d& px, double depth_m) const {
  if (is_pinhole()) {
    const Vector2d xy = ((px - centre_px_).array() / focal_px_.array() * depth_m).matrix();
    return {xy.x(), xy.y(), depth_m};
  }
  const Vector2d xy = depth_m * straight(px).value_or(Vector2d::Constant(kNan));
  return {xy.x(), xy.y(), depth_m};
}

Vector2d Optics::ray(int x, int y) const {
  if (is_pinhole()) return back_project({x, y}, 1).head<2>();
  return {rays_(y, x)[0], rays_(y, x)[1]};
}

}  // namespace lcs::sim
