#include "filter/edges/motion_fix.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "filter/edges/gauss.h"

namespace lcs {
namespace {

/// Standard deviation of the turn that is told of a frame, on an axis, before anything is seen.
constexpr double kTurn_rad = 1e-3;

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
/// is left of it and how well the fix is known by then. The evidence is Laplace's approximation, in
/// which any corner may as well move: else a body of half the picture would be taken for the world.
MotionFix motion_fix(const Intrinsics& camera, const MotionField& field,
                     std::span<const Residual> residuals,
                     const Eigen::Matrix3d& velocity_covariance,
                     const Eigen::Vector3d& velocity_mps) {
  const double dt = field.dt_s();
  const double turn = std::hypot(kTurn_rad, field.unseen_turn_rad());
  const double velocity_variance = velocity_covariance.trace() / 3;
  Matrix6 prior = Matrix6::Zero();  // not inverted, as it is 0 where nothing can be wrong
  prior.topLeftCorner<3, 3>().diagonal().setConstant(turn * turn);
  prior.bottomRightCorner<3, 3>() = velocity_covariance;
  Vector6 expected = Vector6::Zero();
  expected.tail<3>() = velocity_mps;
  Matrix6 covariance = prior;
  Vector6 fix = expected;
  double log_evidence = 0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix6 information = Matrix6::Zero();
    Vector6 pull = Vector6::Zero();
    double log_likelihood = 0;
    for (const Residual& residual : residuals) {
      const Eigen::Matrix<double, 2, 6> J = jacobian(camera, residual, dt);
      // How far a change of velocity moves a point is as uncertain as its depth.
      Eigen::Matrix2d S = residual.covariance_px2;
      S.diagonal().array() += camera.focal_px * camera.focal_px * dt * dt * velocity_variance *
                              residual.inverse_depth_variance_pm2;
      const Vec2 left = residual.off_px - J * fix;
      const double stands = residual.stands * gauss(left, S + J * covariance * J.transpose());
      const Eigen::Matrix<double, 6, 2> weighed = residual.voice * stands /
                                                  (stands + residual.otherwise_ppx2) *
                                                  J.transpose() * S.inverse();
      information += weighed * J;
      pull += weighed * (residual.off_px - J * expected);
      log_likelihood += residual.voice * std::log(gauss(left, S) + residual.moving_ppx2);
    }
    const Matrix6 gained = Matrix6::Identity() + information * prior;
    const Vector6 weights = gained.inverse() * pull;
    const Vector6 change = prior * weights;
    covariance = prior * gained.inverse();
    fix = expected + change;
    log_evidence = log_likelihood - 0.5 * (weights.dot(change) + std::log(gained.determinant()));
  }
  return {fix.head<3>(), fix.tail<3>(), covariance.bottomRightCorner<3, 3>(), log_evidence};
}

void VelocityError::advance(const MotionField& told) {
  const double speed_mps = told.dt_s() > 0 ? told.displacement_C_m().norm() / told.dt_s() : 0;
  const double sigma = std::hypot(told.velocity_sigma_mps(), slip_share_ * speed_mps);
  // What is left of the last frame's error; its variance is what is told all the while.
  const double kept = sigma_mps_ > 0 ? std::min(1.0, sigma / sigma_mps_) : 0;
  const double fresh2 = sigma * sigma - kept * kept * sigma_mps_ * sigma_mps_;
  const Eigen::Matrix3d F = kept * told.R_cur_prev();
  lasting_mps_ = F * lasting_mps_;
  lasting_covariance_ = F * lasting_covariance_ * F.transpose();
  lasting_covariance_.diagonal().array() += fresh2;
  sigma_mps_ = sigma;
}

MotionField VelocityError::without(const MotionField& told) const {
  return told.corrected(Eigen::Vector3d::Zero(), lasting_mps_);
}

Eigen::Matrix3d VelocityError::covariance(const MotionField& field) const {
  const double drift = ego_share_ * field.displacement_C_m().norm() / field.dt_s();
  Eigen::Matrix3d both = lasting_covariance_;
  both.diagonal().array() += drift * drift;
  return both;
}

void VelocityError::see(const MotionFix& fix, const MotionField& field) {
  const Eigen::Matrix3d both = covariance(field);
  const Eigen::Matrix3d share = both.ldlt().solve(lasting_covariance_).transpose();
  lasting_mps_ += share * fix.velocity_mps;
  lasting_covariance_ -= share * (both - fix.velocity_covariance) * share.transpose();
}

void MotionError::advance(const MotionField& told) {
  grip_.advance(told);
  slip_.advance(told);
}

MotionFix MotionError::fix(const Intrinsics& camera, const MotionField& field,
                           std::span<const Residual> residuals, const Fading& fading) {
  const Eigen::Vector3d left_out = likelier().lasting_mps();
  const auto by = [&](VelocityError& error) {
    const Eigen::Vector3d expected = error.lasting_mps() - left_out;
    const MotionFix fix = motion_fix(camera, field, residuals, error.covariance(field), expected);
    MotionFix beyond = fix;
    beyond.velocity_mps -= expected;
    error.see(beyond, field);
    return fix;
  };
  const MotionFix by_grip = by(grip_), by_slip = by(slip_);
  log_odds_ = fading.bounded(fading.faded(log_odds_) + by_slip.log_evidence - by_grip.log_evidence);
  return slips() ? by_slip : by_grip;
}

}  // namespace lcs
