#include "filter/edges/motion_fix.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "filter/edges/gauss.h"

namespace lcs {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// px per rad and m/s: the image motion by a small turn and a change of velocity, first order.
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

/// Normal equations, each residual weighed by the chance that it is of a static point, given what
/// is left of it and how well the fix is known by then.
MotionFix motion_fix(const Intrinsics& camera, const MotionField& told,
                     std::span<const Residual> residuals, double turn_variance_rad2,
                     const Eigen::Matrix3d& velocity_covariance) {
  const double dt = told.dt_s();
  const double velocity_variance = velocity_covariance.trace() / 3;
  Matrix6 prior = Matrix6::Zero();  // not inverted, as it is 0 where nothing can be wrong
  prior.topLeftCorner<3, 3>().diagonal().setConstant(turn_variance_rad2);
  prior.bottomRightCorner<3, 3>() = velocity_covariance;
  Matrix6 covariance = prior;
  Vector6 fix = Vector6::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix6 information = Matrix6::Zero();
    Vector6 pull = Vector6::Zero();
    double weights = 0, misfit = 0;
    for (const Residual& residual : residuals) {
      const Eigen::Matrix<double, 2, 6> J = jacobian(camera, residual, dt);
      // How far a change of velocity moves a point is as uncertain as its depth.
      Eigen::Matrix2d S = residual.covariance_px2;
      S.diagonal().array() += camera.focal_px * camera.focal_px * dt * dt * velocity_variance *
                              residual.inverse_depth_variance_pm2;
      const Vec2 left = residual.off_px - J * fix;
      const double stands = residual.stands * gauss(left, S + J * covariance * J.transpose());
      const double weight = residual.voice * stands / (stands + residual.otherwise_ppx2);
      const Eigen::Matrix2d precision = weight * S.inverse();
      information += J.transpose() * precision * J;
      pull += J.transpose() * precision * residual.off_px;
      misfit += residual.off_px.dot(precision * residual.off_px);
      weights += 2 * weight;
    }
    const auto known = [&](double share) -> Matrix6 {
      return (Matrix6::Identity() + share * prior * information).inverse() * prior;
    };
    fix = known(1) * pull;
    // What is off by more than it should be tells by as much less.
    misfit += fix.dot(information * fix - 2 * pull);
    covariance = known(misfit > weights ? weights / misfit : 1);
  }
  return {fix.head<3>(), fix.tail<3>(), covariance.bottomRightCorner<3, 3>(),
          covariance.topLeftCorner<3, 3>().trace() / 3};
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

}  // namespace lcs
