#include "filter/edges/track.h"

#include "filter/edges/gauss.h"

namespace lcs {

OwnMotion OwnMotion::first(const Vec2& before_px, const Vec2& x_px, double noise2_px2,
                           double dt_s) {
  OwnMotion motion{x_px, (x_px - before_px) / dt_s, {}};
  motion.covariance << 1, 1 / dt_s, 1 / dt_s, 2 / (dt_s * dt_s);
  motion.covariance *= noise2_px2;
  return motion;
}

OwnMotion OwnMotion::predicted(const MotionField& field, double acceleration) const {
  const double dt = field.dt_s();
  OwnMotion next;
  next.place_px = moved(field);
  next.velocity_pxps = velocity_pxps;
  Eigen::Matrix2d F;
  F << 1, dt, 0, 1;
  // Velocity as a random walk: the variances of velocity and place at the frame's end.
  const double change2 = acceleration * acceleration * dt * dt * velocity_pxps.squaredNorm();
  Eigen::Matrix2d Q;
  Q << dt * dt / 3, dt / 2, dt / 2, 1;
  next.covariance = F * covariance * F.transpose() + change2 * Q;
  return next;
}

void OwnMotion::update(const Vec2& x_px, double noise2_px2) {
  const double S = covariance(0, 0) + noise2_px2;
  const Eigen::Vector2d gain = covariance.col(0) / S;
  const Vec2 residual = x_px - place_px;
  place_px += gain.x() * residual;
  velocity_pxps += gain.y() * residual;
  covariance -= gain * S * gain.transpose();
}

double OwnMotion::density(const Vec2& x_px, double noise2_px2) const {
  return gauss(x_px - place_px, covariance(0, 0) + noise2_px2);
}

}  // namespace lcs
