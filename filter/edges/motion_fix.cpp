#include "filter/edges/motion_fix.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "filter/edges/gauss.h"
#include "filter/matching/point_grid.h"

namespace lcs {
namespace {

/// Prior standard deviation of the error of a frame's given rotation, on each axis.
constexpr double kTurn_rad = 1e-3;
/// Share of static tracks that may leave their predictions; a larger share contradicts the motion.
constexpr double kLeave = 0.8;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// px per rad and m/s: derivative of the image motion by a small turn and a change of velocity.
Eigen::Matrix<double, 2, 6> jacobian(const Intrinsics& camera, const Residual& residual,
                                     double dt_s) {
  const Vec2 h = (residual.place_px - camera.centre_px) / camera.focal_px;
  Eigen::Matrix<double, 2, 6> J;
  J.leftCols<3>() << h.x() * h.y(), -(1 + h.x() * h.x()), h.y(), 1 + h.y() * h.y(), -h.x() * h.y(),
      -h.x();
  J.rightCols<3>() << -1, 0, h.x(), 0, -1, h.y();
  J.rightCols<3>() *= residual.inverse_depth_pm * dt_s;
  return camera.focal_px * J;
}

}  // namespace

/// Iterated weighted least squares. A residual's weight is the probability of a static point, given
/// the residual and the covariance of the current fix.
MotionFix motion_fix(const Intrinsics& camera, const MotionField& told,
                     std::span<const Residual> residuals,
                     const Eigen::Matrix3d& velocity_covariance) {
  const double dt = told.dt_s();
  const double turn = std::hypot(kTurn_rad, told.unseen_turn_rad());
  const double velocity_variance = velocity_covariance.trace() / 3;
  Matrix6 prior = Matrix6::Zero();  // not inverted: 0 if the motion is exact
  prior.topLeftCorner<3, 3>().diagonal().setConstant(turn * turn);
  prior.bottomRightCorner<3, 3>() = velocity_covariance;
  Matrix6 left_open = prior, covariance = prior;
  Vector6 fix = Vector6::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix6 information = Matrix6::Zero();
    Vector6 pull = Vector6::Zero();
    for (const Residual& residual : residuals) {
      const Eigen::Matrix<double, 2, 6> J = jacobian(camera, residual, dt);
      // The effect of a change of velocity on a point is as uncertain as the point's depth.
      Eigen::Matrix2d S =
          residual.covariance_px2 + residual.by_depth_px * residual.by_depth_px.transpose();
      S.diagonal().array() += camera.focal_px * camera.focal_px * dt * dt * velocity_variance *
                              residual.inverse_depth_variance_pm2;
      // The precision across a segment of a million pixels is lost in rounding.
      if (!(S.determinant() > 1e-12 * S.trace() * S.trace())) continue;
      const Vec2 left = residual.off_px - J * fix;
      const double stands = residual.stands * gauss(left, S + J * left_open * J.transpose());
      const double weight = residual.voice * stands / (stands + residual.otherwise_ppx2);
      const Eigen::Matrix2d precision = weight * S.inverse();
      const Eigen::Matrix<double, 6, 2> weighed = J.transpose() * precision;
      information += weighed * J;
      pull += weighed * residual.off_px;
    }
    covariance = (Matrix6::Identity() + prior * information).inverse() * prior;
    fix = covariance * pull;
    // Wrong matches pull the first rounds far off; later rounds search closer.
    left_open = covariance + prior * std::pow(kFar, -2 * (iteration + 1));
  }
  return {fix.head<3>(), fix.tail<3>(), covariance.bottomRightCorner<3, 3>()};
}

bool is_contradicted(std::span<const Residual> residuals) {
  double left = 0, stood = 0, all = 0;
  for (const Residual& residual : residuals) {
    const double stands = residual.stands * gauss(residual.off_px, residual.covariance_px2);
    left += residual.voice * residual.stands * residual.otherwise_ppx2 /
            (stands + residual.otherwise_ppx2);
    stood += residual.voice * residual.stands;
    all += residual.voice;
  }
  return stood >= 0.5 * all && left > kLeave * stood;
}

void VelocityError::advance(const MotionField& told, double lasts) {
  if (!(told.dt_s() > 0)) return forget();
  const double speed_mps = told.displacement_C_m().norm() / told.dt_s();
  const double sigma = std::hypot(told.velocity_sigma_mps(), share_ * speed_mps);
  const double kept = sigma_mps_ > 0 ? lasts * std::min(1.0, sigma / sigma_mps_) : 0;
  const Eigen::Matrix3d F = kept * told.R_cur_prev();
  mean_mps_ = F * mean_mps_;
  covariance_ = F * covariance_ * F.transpose();
  covariance_.diagonal().array() += sigma * sigma - kept * kept * sigma_mps_ * sigma_mps_;
  sigma_mps_ = sigma;
}

Eigen::Vector3d VelocityError::see(const MotionFix& fix) {
  const Eigen::Vector3d before_mps = mean_mps_;
  mean_mps_ += fix.velocity_mps;
  covariance_ = fix.velocity_covariance;
  if (mean_mps_.norm() > kFar * sigma_mps_) mean_mps_.setZero();
  return mean_mps_ - before_mps;
}

}  // namespace lcs
